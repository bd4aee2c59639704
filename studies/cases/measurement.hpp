#pragma once

/// @file
/// A check together with the way to take it.

#include <functional>
#include <utility>
#include <vector>

#include "studies/cases/finding.hpp"

namespace acstudy {

struct SeriesResult;

/// A check and how it is taken.
struct Measurement {
  using Results = std::vector<SeriesResult>;

  Check check;
  /// Gives a finding its points, and a remark if there is one; gets the results of the study's series, which may be
  /// none.
  std::function<void(Finding&, const Results&)> measure;

  Measurement(Check its_check, std::function<void(Finding&, const Results&)> how)
      : check(std::move(its_check)), measure(std::move(how)) {}
  Measurement(Check its_check, std::function<void(Finding&)> how)
      : check(std::move(its_check)),
        measure([how = std::move(how)](Finding& finding, const Results&) { how(finding); }) {}

  /// The finding, judged. What goes wrong numerically while it is measured becomes its failure.
  Finding take(const Results& results) const;
  Finding take() const;
};

}  // namespace acstudy
