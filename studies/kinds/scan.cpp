#include "reports/judging/scan.hpp"

#include <fmt/format.h>

#include "studies/claims/once.hpp"
#include "studies/kinds/kinds.hpp"

namespace acstudy {

namespace {

constexpr double most_false = 0.001, least_decided = 0.95;

double share(std::int64_t part, std::int64_t of) { return static_cast<double>(part) / static_cast<double>(of); }

Finding false_verdicts(const std::string& subject) {
  return {.statement = "scan",
          .claim = "firm verdicts pass what departs, or condemn what holds, less than once in a thousand times",
          .subject = subject,
          .quantity = "share of verdicts that are firm and false",
          .test = Test::bounds,
          .variable = "levels",
          .promised = Verdict::holds,
          .expected = Verdict::holds};
}

Finding decided_verdicts(const std::string& subject) {
  return {.statement = "scan",
          .claim = "where the last pairwise order shows the truth, 95 verdicts in 100 are not inconclusive",
          .subject = subject,
          .quantity = "share of verdicts that are not inconclusive",
          .test = Test::bounds,
          .variable = "levels",
          .promised = Verdict::holds,
          .expected = Verdict::holds};
}

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
  const auto measure = [&](Finding finding, auto points) {
    const std::string name = finding.label();
    study.measurements.push_back({name, [finding = std::move(finding), points](const auto&) {
                                    Finding measured = finding;
                                    points(measured);
                                    judge(measured);
                                    return measured;
                                  }});
  };
  const auto put_false = [](Finding& finding, const ScanRow& row, bool bounded) {
    Point point{
        .N = row.judged, .variable = static_cast<double>(row.levels), .value = share(row.false_firm, row.judged)};
    if (bounded) point.upper = most_false;
    finding.points.push_back(point);
  };
  const auto put_decided = [](Finding& finding, const ScanRow& row, bool bounded) {
    Point point{
        .N = row.decidable, .variable = static_cast<double>(row.levels), .value = share(row.decided, row.decidable)};
    if (bounded) point.lower = least_decided;
    finding.points.push_back(point);
  };

  const auto scan = once([=] { return scan_two_terms(every, seed); });
  const auto all = [&](Finding finding, auto put) {
    finding.check = "all series";
    measure(finding, [=](Finding& measured) { put(measured, scan().all(), true); });
  };
  all(false_verdicts("false firm verdicts"), put_false);
  all(decided_verdicts("decided verdicts"), put_decided);
  for (const Printing printing : printings) {
    const auto by_levels = [&](Finding finding, auto put) {
      finding.check = name_of(printing);
      finding.expect_no_bound();
      measure(finding, [=](Finding& measured) {
        for (const ScanRow& row : scan().rows) {
          if (row.printing == printing) put(measured, row, false);
        }
      });
    };
    by_levels(false_verdicts("false firm verdicts"), put_false);
    by_levels(decided_verdicts("decided verdicts"), put_decided);
  }

  const auto control = [&](Finding finding, const JudgeOrders& judge, auto put, const char* remark) {
    finding.check = "all series";
    finding.expected = Verdict::violated;
    finding.remark = remark;
    measure(finding, [=](Finding& measured) { put(measured, scan_two_terms(every, seed, judge).all(), true); });
  };
  control(false_verdicts("interval of the power law (control)"), judge_by_power_law, put_false,
          "An interval that takes no correction into account is firm where orders still move.");
  control(decided_verdicts("never decides (control)"), never_decide, put_decided, "Who says nothing is never wrong.");
}

constexpr Key scan_keys[] = {
    {"every", "whole number", "judges one series in so many; 1: all"},
    {"seed", "whole number", "of noise and of the choice"},
};
constexpr TableKeys tables[] = {{"[scan]", scan_keys}};

}  // namespace

const Kind scan_kind{"scan", "how often verdicts are firm and wrong, and how often they decide", tables, read_scan};

}  // namespace acstudy
