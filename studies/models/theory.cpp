#include "studies/models/theory.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace acstudy {

std::string theorem(const SchemeChoice& scheme, bool standing) {
  const Theorems& theorems = scheme.model->theorems;
  return std::string(standing ? theorems.standing : scheme.nonlocal_divergence ? theorems.nonlocal : theorems.local);
}

Theory theory_for(const SchemeChoice& scheme, bool standing, bool nonlocal_source, bool fixed_horizon,
                  bool below_spacing) {
  const std::string statement = theorem(scheme, standing);
  const ModelCard& model = *scheme.model;
  const auto part = [&](int number) {
    return model.beyond_paper ? statement : fmt::format("{} ({})", statement, number);
  };
  if (model.order_in_h) return {"h", model.order, statement};
  if (nonlocal_source) {
    // A second term, h^2/delta or h^3/delta^2, does not vanish for delta below h; there both the nonlocal model and the
    // scheme are within O(max(h, delta)) of the PDE, so part (2) carries over.
    const auto& estimates = scheme.model->estimates;
    const bool second_term = std::any_of(estimates.begin(), estimates.end(),
                                         [](const LemmaEstimate& estimate) { return !estimate.second_term.empty(); });
    if (second_term && below_spacing) return {"max(h,delta)", 1.0, part(2)};
    return {"h", 1.0, part(1)};
  }
  if (fixed_horizon && !below_spacing) {
    return {"h", 0.0, part(1) + ": the limit is the nonlocal model at this horizon, not the PDE"};
  }
  return {"max(h,delta)", model.order, part(2)};
}

}  // namespace acstudy
