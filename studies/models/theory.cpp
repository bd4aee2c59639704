#include "studies/models/theory.hpp"

namespace acstudy {

std::string theorem(const SchemeChoice& scheme, bool standing) {
  const int offset = standing ? 0 : scheme.nonlocal_divergence ? 2 : 1;
  return scheme.model == 1 ? "Theorem 2." + std::to_string(6 + offset) : "Theorem 3." + std::to_string(5 + offset);
}

Theory theory_for(const SchemeChoice& scheme, bool standing, bool nonlocal_source, bool fixed_horizon,
                  bool below_spacing) {
  const std::string statement = theorem(scheme, standing);
  if (nonlocal_source) {
    // Part (1) of Model II has the terms h^2/delta and h^3/delta^2, which do not vanish for delta below h; there both
    // the nonlocal model and the scheme are within O(max(h, delta)) of the PDE, so part (2) carries over.
    if (scheme.model == 2 && below_spacing) return {"max(h,delta)", 1.0, statement + " (2)"};
    return {"h", 1.0, statement + " (1)"};
  }
  if (fixed_horizon && !below_spacing) {
    return {"h", 0.0, statement + " (1): the limit is the nonlocal model at this horizon, not the PDE"};
  }
  return {"max(h,delta)", 1.0, statement + " (2)"};
}

}  // namespace acstudy
