#pragma once

/// @file
/// What came of a study, and the verdicts on its series.

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reports/judging/orders.hpp"
#include "studies/cases/case_result.hpp"
#include "studies/cases/study.hpp"

namespace acstudy {

/// A series with its results, `results[i]` being that of `series.cases[i]`, and the judgement on them.
struct SeriesResult {
  const Series* series;
  std::vector<CaseResult> results;
  Judgement judgement;
  /// Indices of the cases that have a result.
  std::vector<std::size_t> completed() const;
  /// The same without the reference.
  std::vector<std::size_t> completed_levels() const;
  /// That of the reference, where the series has one and its run is done; else nothing.
  const CaseResult* reference() const;
  /// The verdict is the expected one, and no case is missing.
  bool as_expected() const {
    return completed().size() == series->cases.size() && meets(judgement.verdict, series->expected) &&
           !(failed() && series->expected == Verdict::stable);
  }
  /// A case has no solution for a reason other than a blow-up.
  bool failed() const {
    return std::any_of(results.begin(), results.end(), [](const CaseResult& r) { return !r.failure.empty(); });
  }
};

/// A study with everything that has been computed of it; `findings[i]` is that of `study->measurements[i]`, absent
/// where the run was interrupted.
struct StudyResult {
  const Study* study = nullptr;
  std::vector<SeriesResult> series;
  std::vector<std::optional<Finding>> findings;
};

/// The reason of a series of which a case could not be computed; its verdict is `inconclusive`.
std::string not_computed(const std::string& failure);

/// Judges the errors of levels; where they are differences to a reference, which has an error itself, as such.
///
/// If errors are C v^p, differences are C (v^p - v_r^p), and fall the faster the nearer they are to the reference. So
/// they are divided by 1 - (v_r/v)^p, with theory's p: if theory is right, these are the errors. If they are `below` or
/// `above` nevertheless, p is the order that they then show themselves.
Judgement judge_errors(const std::vector<Level>& levels, const std::optional<ReferenceLevel>& reference,
                       double theory_order, const JudgeOptions& options);

/// Where nothing but stability is expected, an error of so many times the solution is `unstable`, too.
inline constexpr double largest_stable_error = 100.0;
void require_bounded(Judgement& judgement, double error, double solution);

/// The largest max |u| of the cases of a series, by which round-off is known; nothing where none is positive and
/// finite.
std::optional<double> solution_scale(std::span<const double> solutions);

/// Judges a series on its completed cases.
Judgement judge_series(const Series& series, const std::vector<CaseResult>& results);

}  // namespace acstudy
