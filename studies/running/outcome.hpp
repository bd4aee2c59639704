#pragma once

/// @file
/// What a run comes to: fields and errors at its end, or at the last state that makes sense.

#include <functional>
#include <span>
#include <stdexcept>
#include <string>

#include "studies/running/run_case.hpp"
#include "studies/running/watch.hpp"

namespace acstudy {

/// Errors of u against the exact solution at x and t; NaN if one is.
struct Errors {
  double linf = 0.0, l1 = 0.0, l2 = 0.0;  ///< the latter two weighted by cell width and divided by the period
};
Errors errors_of(const Scene& scene, std::span<const double> x, std::span<const double> u,
                 std::span<const double> u_exact);

/// Why a run ended in the step after those of `result`, which began at time t.
std::string failure_in_step(const std::domain_error& error, const CaseResult& result, double t);

/// Fills in fields, errors and how the run ended. Without an exact solution errors are NaN, and there is no `u_exact`.
/// @param u          at time t
/// @param positions  of the particles at a time
void conclude(CaseResult& result, const Case& c, const GrowthWatch& growth, std::span<const double> u, double t,
              double solution_at_first, const std::function<std::span<const double>(double)>& positions);

}  // namespace acstudy
