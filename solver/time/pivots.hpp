#pragma once

/// @file
/// What direct solvers do with a pivot.

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace acstudy {

/// What is smaller beside a pivot changes no digit of any solution, and would become denormal, which is slow.
inline constexpr double negligible = 1e-60;

[[noreturn]] inline void refuse_singular() { throw std::domain_error("the matrix of the implicit step is singular"); }

/// 1/pivot.  @throws std::domain_error if the pivot is zero or not finite
inline double inverse_of(double pivot) {
  const double inverse = 1.0 / pivot;
  if (!(std::abs(inverse) <= std::numeric_limits<double>::max()) || inverse == 0.0) refuse_singular();
  return inverse;
}

inline bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

}  // namespace acstudy
