#pragma once

/// @file
/// [time]: how a study steps.

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "reports/judging/orders.hpp"
#include "studies/cases/case.hpp"
#include "studies/reading/toml_table.hpp"

namespace acstudy {

/// One way to step.
struct Stepping {
  const Integrator* integrator;
  StepRule rule;
  std::optional<Expression> step;  ///< upper bound of equal steps; absent where these follow a bound or a tolerance
  Place at_step;
  std::optional<Expression> tolerance = {}, first = {};  ///< of adaptive steps; without `first` it is h
  Place at_tolerance = {}, at_first = {};
  double limit = std::numeric_limits<double>::infinity();  ///< seconds that a case may take
  std::optional<Verdict> expect = {};                      ///< in place of what paths expect
  std::string label = {};  ///< for the labels of series, where a study has several ways to step
};
/// [time], or all of [[time]], each with a label of its own where there are several.
std::vector<Stepping> read_steppings(const Table& root);

/// Gives a case its steps: `dt` and `steps`, and the tolerance of adaptive ones.
void set_steps(Case& c, const Stepping& time);

}  // namespace acstudy
