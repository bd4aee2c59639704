#pragma once

/// @file
/// What a run comes to: fields and errors at its end, or at the last state that makes sense.

#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "studies/running/run_case.hpp"
#include "studies/running/watch.hpp"

namespace acstudy {

/// The widths of the cells of particles on a periodic line, from the middle of one gap to that of the next.
/// @param x  increasing within one period
std::vector<double> widths_on_line(std::span<const double> x, double period);

/// The volumes of the cells of particles at points, shape [N].
using Volumes = std::function<std::vector<double>(const Points& x)>;

/// Norms of u - u_exact, in any dimension; NaN if one of the values is.
struct Errors {
  double linf = 0.0, l1 = 0.0, l2 = 0.0;  ///< the latter two weighted by volume and divided by that of the whole
};
/// @param volumes  of the particles' cells, shape [N]
/// @param whole    their sum
Errors errors_of(std::span<const double> volumes, double whole, std::span<const double> u,
                 std::span<const double> u_exact);

/// Why a run ended in the step after those of `result`, which began at time t.
std::string failure_in_step(const std::domain_error& error, const CaseResult& result, double t);

/// Fills in fields, errors and how the run ended. Without an exact solution errors are NaN, and there is no `u_exact`.
/// @param u          at time t
/// @param positions  of the particles at a time
void conclude(CaseResult& result, const Case& c, const GrowthWatch& growth, std::span<const double> u, double t,
              double solution_at_first, const std::function<Points(double)>& positions, const Volumes& volumes);

}  // namespace acstudy
