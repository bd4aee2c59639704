#pragma once

/// @file
/// A finding: one statement of theory, what was measured, and whether the two agree.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reports/judging/orders.hpp"
#include "reports/judging/surface.hpp"

namespace acstudy {

/// How the points of a finding are judged.
enum class Test {
  order,    ///< the values vanish with theory's order in `variable`
  rate,     ///< they vanish with at least that order: verdict `holds`, or that of the order that they have
  bounds,   ///< every value lies within [lower, upper]: verdict `holds` or `violated`
  surface,  ///< the values vanish with theory's order in h and in delta, however the two go to zero
};

std::string_view name_of(Test test);
std::optional<Test> test_from(std::string_view name);

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

struct Finding {
  std::string statement;  ///< of theory: "Lemma 2.3"
  std::string claim;      ///< what it says: "truncation error O(h), whatever delta"
  std::string subject;    ///< what it is said of: "Model I, local divergence, inverse"
  std::string check;      ///< under which conditions: "jittered, delta = 4h"
  std::string quantity;   ///< what the values are: "max |rate + f - du/dt|"
  Test test;
  std::string variable;                ///< name of `Point::variable`: "h"
  double theory_order = 0.0;           ///< of every test but Test::bounds
  Verdict promised;                    ///< the verdict if the statement is true
  Verdict expected;                    ///< the verdict that the study demands: another one for a negative control
  std::vector<Verdict> also_expected;  ///< verdicts that are as right as the expected one
  std::vector<Point> points;
  JudgeOptions known = {.scale = 1.0};  ///< of the size of what the values are errors of; fields have size 1
  std::string remark;                   ///< what a reader must know besides; may be empty
  std::string failure;                  ///< why it could not be measured, if so: the verdict is then `inconclusive`

  Judgement judgement;                ///< set by judge()
  std::optional<SurfaceFit> surface;  ///< set by judge() for Test::surface, where the values allow it

  std::string label() const { return statement + ": " + subject + "; " + check; }
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
