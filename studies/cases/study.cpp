#include "studies/cases/study.hpp"

namespace acstudy {

std::optional<ReferenceLevel> Series::reference_level() const {
  if (!against_reference) return std::nullopt;
  const Case& c = cases.back();
  return ReferenceLevel{c.N, variable(c.h, c.delta)};
}

std::string Series::label() const {
  return scheme_label(scheme, cases.front().scene->standing()) + ", " + path +
         (stepping.empty() ? "" : ", " + stepping);
}

}  // namespace acstudy
