#pragma once

/// @file
/// The verdict on a series of runs: the errors along a path, judged by their order.

#include <vector>

#include "studies/cases/measurement.hpp"
#include "studies/cases/study.hpp"

namespace acstudy {

/// What theory says of a series, as a check.
/// @param series  its cases do not matter
/// @param number  in its study
Check series_check(const Series& series, double mu, bool standing, std::size_t number);

/// The check of a series with its cases, and the way to take it from their results.
Measurement series_verdict(const Series& series, std::size_t number);

/// Adds the error of a level to a finding on a series.
/// @param solution  largest exact |u| there, by which round-off is known; NaN if it is not
void add_level(Finding& finding, Point point, double solution);

/// More levels would not be asked for: they are confirmed, or it is known why they are not.
/// @pre  the finding is judged
bool is_decided(const Finding& finding);

/// Judges a finding on a series.
/// @pre finding.cases
void judge_series(Finding& finding);

/// Judges the errors of levels; where they are differences to a reference, which has an error itself, as such.
///
/// If errors are C v^p, differences are C (v^p - v_r^p), and fall the faster the nearer they are to the reference. So
/// they are divided by 1 - (v_r/v)^p, with theory's p: if theory is right, these are the errors. If they are `below` or
/// `above` nevertheless, p is the order that they then show themselves.
Judgement judge_errors(const std::vector<Level>& levels, const std::optional<ReferenceLevel>& reference,
                       double theory_order, const JudgeOptions& options);

/// Where nothing but stability is expected, an error of so many times the solution is `unstable`, too.
inline constexpr double largest_stable_error = 100.0;

}  // namespace acstudy
