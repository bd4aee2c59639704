#pragma once

/// @file
/// Errors where no solution is known: against the finest run of the series.

#include <span>
#include <vector>

#include "studies/cases/case_result.hpp"
#include "studies/cases/study.hpp"

namespace acstudy {

/// A periodic solution, known at particles, at other places.
///
/// By least squares, a polynomial of degree 5 through the four particles on each side. So particles that nearly
/// coincide do no harm, which an interpolating polynomial would not bear. Smooth solutions: of order 6 in the spacing.
/// @param x   positions of at least one particle, increasing, within one period
/// @param at  any, also beyond the period
std::vector<double> interpolate_on_line(std::span<const double> x, std::span<const double> u, double period,
                                        std::span<const double> at);

/// The reference at the places `at`: its own values where it has a particle at each of them, else interpolated.
/// @param x, u  of the reference
std::vector<double> values_on_line(std::span<const double> x, std::span<const double> u, double period,
                                   std::span<const double> at);

/// Sets the errors of a series that is judged against its reference: of every run that went to its end, if the
/// reference did. NaN otherwise. `u_exact` becomes the reference at the particles.
/// @pre  series.against_reference; results[i] is that of series.cases[i]
void compare_with_reference(const Series& series, std::vector<CaseResult>& results);

}  // namespace acstudy
