#pragma once

/// @file
/// What came of a study.

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reports/judging/orders.hpp"
#include "studies/cases/case_result.hpp"
#include "studies/cases/study.hpp"

namespace acstudy {

/// A series with its results, `results[i]` being that of `series.cases[i]`. There are as many as are asked for: all, or
/// those up to the level that decides.
struct SeriesResult {
  const Series* series;
  std::vector<CaseResult> results;
  /// Indices of the cases that have a result.
  std::vector<std::size_t> completed() const;
  /// The same without the reference.
  std::vector<std::size_t> completed_levels() const;
  /// That of the reference, where the series has one and its run is done; else nothing.
  const CaseResult* reference() const;
};

/// A study with everything that has been computed of it; `findings[i]` is that of `study->measurements[i]`, absent
/// where the run was interrupted.
struct StudyResult {
  const Study* study = nullptr;
  std::vector<SeriesResult> series;
  std::vector<std::optional<Finding>> findings;
};

}  // namespace acstudy
