#include "reports/judging/scan.hpp"

#include <limits>
#include <string>

#include "studies/claims/once.hpp"
#include "studies/kinds/kinds.hpp"

namespace acstudy {

namespace {

/// A share of the verdicts on all series, or on those of some printing.
struct Share {
  const char *subject, *claim, *quantity;
  std::int64_t ScanRow::*part;
  std::int64_t ScanRow::*of;
  double lower, upper;

  Check check(const std::string& on) const {
    return {.statement = "scan",
            .claim = claim,
            .subject = subject,
            .coordinates = {{"series", on}},
            .quantity = quantity,
            .variable = "levels"};
  }
  Point point(const ScanRow& row) const {
    return {.N = row.*of,
            .variable = static_cast<double>(row.levels),
            .value = static_cast<double>(row.*part) / static_cast<double>(row.*of)};
  }
  Point bounded(const ScanRow& row) const {
    Point one = point(row);
    one.lower = lower;
    one.upper = upper;
    return one;
  }
};

constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr Share false_verdicts = {
    "false firm verdicts",
    "firm verdicts pass what departs, or condemn what holds, less than once in a thousand times",
    "share of verdicts that are firm and false",
    &ScanRow::false_firm,
    &ScanRow::judged,
    -unbounded,
    0.001};
constexpr Share decided_verdicts = {
    "decided verdicts",
    "where the last pairwise order shows the truth, 95 verdicts in 100 are not inconclusive",
    "share of verdicts that are not inconclusive",
    &ScanRow::decided,
    &ScanRow::decidable,
    0.95,
    unbounded};

/// A judge that asks only whether the interval of a power law contains the order.
std::vector<Verdict> judge_by_power_law(LevelView levels, const std::vector<double>& orders) {
  const PowerLaw line = fit_power_law(levels);
  std::vector<Verdict> verdicts;
  for (const double order : orders) {
    verdicts.push_back(order < line.low    ? Verdict::above
                       : order > line.high ? Verdict::below
                       : order == 0.0      ? Verdict::stagnates
                                           : Verdict::confirmed);
  }
  return verdicts;
}

std::vector<Verdict> never_decide(LevelView, const std::vector<double>& orders) {
  return std::vector(orders.size(), Verdict::inconclusive);
}

void read_scan(const Table& root, Study& study) {
  const Table table = root.sub_table("scan");
  const auto every = table.whole("every", table.need("every", "every = 23"), 1, 10'000);
  const auto seed = static_cast<std::uint64_t>(table.whole("seed", table.need("seed", "seed = 1"), 0, 1'000'000'000));
  const auto scan = once([=] { return scan_two_terms(every, seed); });
  for (const Share& share : {false_verdicts, decided_verdicts}) {
    study.measurements.emplace_back(share.check("all series"),
                                    [=](Finding& finding) { finding.points.push_back(share.bounded(scan().all())); });
  }
  for (const Printing printing : printings) {
    for (const Share& share : {false_verdicts, decided_verdicts}) {
      Check check = share.check(std::string(name_of(printing)));
      check.promised = check.expected = Verdict::inconclusive;  // for the record: theory bounds none of them
      study.measurements.emplace_back(check, [=](Finding& finding) {
        for (const ScanRow& row : scan().rows) {
          if (row.printing == printing) finding.points.push_back(share.point(row));
        }
      });
    }
  }

  const auto add_control = [&](const Share& share, const char* subject, const JudgeOrders& judge, const char* why) {
    Check check = share.check("all series");
    check.subject = subject;
    check.expected = Verdict::violated;
    check.remark = why;
    study.measurements.emplace_back(check, [=](Finding& finding) {
      finding.points.push_back(share.bounded(scan_two_terms(every, seed, judge).all()));
    });
  };
  add_control(false_verdicts, "interval of the power law (control)", judge_by_power_law,
              "An interval that takes no correction into account is firm where orders still move.");
  add_control(decided_verdicts, "never decides (control)", never_decide, "Who says nothing is never wrong.");
}

constexpr Key scan_keys[] = {
    {"every", "whole number", "judges one series in so many; 1: all"},
    {"seed", "whole number", "of noise and of the choice"},
};
constexpr TableKeys scan_tables[] = {{"[scan]", scan_keys}};

}  // namespace

const Kind scan_kind{"scan", "how often verdicts are firm and wrong, and how often they decide", scan_tables,
                     read_scan};

}  // namespace acstudy
