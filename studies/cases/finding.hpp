#pragma once

/// @file
/// A finding: a check, what was measured, and whether the two agree.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "reports/judging/surface.hpp"
#include "studies/cases/check.hpp"

namespace acstudy {

/// One measured value. What does not apply is NaN, and 0 for N.
struct Point {
  std::int64_t N = 0;
  double h = std::numeric_limits<double>::quiet_NaN(), delta = std::numeric_limits<double>::quiet_NaN();
  double variable = std::numeric_limits<double>::quiet_NaN();  ///< what the order is in, or `value` is drawn over
  double value = std::numeric_limits<double>::quiet_NaN();
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  std::string label;  ///< what the value is, where a finding has values of several sorts
};

/// A check with what was measured. What was expected of values that theory turns out not to bound is part of it.
struct Finding : Check {
  std::vector<Point> points = {};
  std::string failure = {};  ///< why it could not be measured, if so: the verdict is then `inconclusive`

  Judgement judgement = {};                ///< set by judge()
  std::optional<SurfaceFit> surface = {};  ///< set by judge() for Test::surface, where the values allow it

  bool as_expected() const {
    return meets(judgement.verdict, expected) ||
           std::find(also_expected.begin(), also_expected.end(), judgement.verdict) != also_expected.end();
  }
  /// For values that theory does not bound at all: they are for the record, and no evidence.
  void expect_no_bound() { promised = expected = Verdict::inconclusive; }
  /// The statement does not hold of the subject, expected or not.
  bool alarm() const { return !meets(judgement.verdict, promised); }
};

/// Sets `judgement` from the points.
void judge(Finding& finding);

}  // namespace acstudy
