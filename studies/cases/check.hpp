#pragma once

/// @file
/// A check: a statement of theory with all that is known of it before anything is measured.

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "reports/judging/orders.hpp"

namespace acstudy {

/// How the points of a check are judged.
enum class Test {
  order,    ///< the values vanish with theory's order in `variable`
  rate,     ///< they vanish with at least that order: verdict `holds`, or that of the order that they have
  bounds,   ///< every value lies within [lower, upper]: verdict `holds` or `violated`
  surface,  ///< the values vanish with theory's order in h and in delta, however the two go to zero
};

std::string_view name_of(Test test);
std::optional<Test> test_from(std::string_view name);

/// One of the conditions under which a statement is examined.
struct Coordinate {
  using Value = std::variant<std::string, double>;

  std::string name;  ///< that result files give it: "cfl"
  Value value;
  std::string words;   ///< what a reader sees of it: "CFL 1.5"
  bool spoken = true;  ///< part of the check's name

  /// A text that speaks for itself: "jittered".
  Coordinate(std::string its_name, std::string text) : name(std::move(its_name)), value(text), words(std::move(text)) {}
  Coordinate(std::string its_name, Value its_value, std::string its_words)
      : name(std::move(its_name)), value(std::move(its_value)), words(std::move(its_words)) {}
};

/// One that the name goes without, as what it says is said of the subject; see `tell_apart`.
Coordinate unspoken(Coordinate coordinate);
/// "CFL 1.5"
Coordinate at_cfl(double cfl);
/// "delta = 0.1"
Coordinate at_horizon(double delta);
/// "delta = 4h"
Coordinate at_ratio(double delta_over_h);

/// Everything that is known of a finding before it is measured. What explains a study, labels a failure, names a test
/// case or stands in a result file comes from here.
struct Check {
  std::string statement;                ///< of theory: "Lemma 2.3"
  std::string claim;                    ///< what it says: "truncation error O(h), whatever delta"
  std::string subject;                  ///< what it is said of: "Model I, local divergence, inverse"
  std::vector<Coordinate> coordinates;  ///< under which conditions, each name once
  std::string quantity;                 ///< what the values are: "max |rate + f - du/dt|"
  Test test = Test::bounds;
  std::string variable;                 ///< name of `Point::variable`: "h"
  double theory_order = 0.0;            ///< of every test but Test::bounds
  Verdict promised = Verdict::holds;    ///< the verdict if the statement is true
  Verdict expected = Verdict::holds;    ///< the verdict that the study demands: another one for a negative control
  std::vector<Verdict> also_expected;   ///< verdicts that are as right as the expected one
  JudgeOptions known = {.scale = 1.0};  ///< of the size of what the values are errors of; fields have size 1
  std::string remark;                   ///< what a reader must know besides; may be empty

  /// The spoken coordinates: "jittered, delta = 4h".
  std::string conditions() const;
  /// The name of the check, of which a study has no second: "Lemma 2.3: Model I, inverse; jittered, delta = 4h".
  std::string label() const { return statement + ": " + subject + "; " + conditions(); }
  /// Makes it one that must fail; `why` it must.
  void be_control(const std::string& why, Verdict verdict = Verdict::violated);
};

/// Where checks have the same name, the unspoken coordinates in which they differ are spoken.
/// @return the first name that two of them have all the same; empty if there is none
std::string tell_apart(const std::vector<Check*>& checks);

}  // namespace acstudy
