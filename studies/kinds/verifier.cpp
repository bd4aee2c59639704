#include <fmt/format.h>

#include <algorithm>

#include "reports/judging/corpus.hpp"
#include "reports/judging/coverage.hpp"
#include "reports/judging/value_corpus.hpp"
#include "reports/judging/value_coverage.hpp"
#include "studies/claims/once.hpp"
#include "studies/kinds/kinds.hpp"

namespace acstudy {

namespace {

Finding corpus_finding(const CorpusEntry& entry) {
  Finding finding{.statement = "corpus",
                  .claim = entry.why,
                  .subject = entry.name,
                  .check = "verdict",
                  .quantity = "synthetic error",
                  .test = Test::order,
                  .variable = "v",
                  .theory_order = entry.theory_order,
                  .promised = entry.right.front(),
                  .expected = entry.right.front()};
  finding.also_expected.assign(entry.right.begin() + 1, entry.right.end());
  finding.known = entry.options;
  for (const Level& level : entry.levels) finding.points.push_back({.variable = level.variable, .value = level.error});
  return finding;
}

/// Whether the verdict on each sequence of values is right: a point of value 1 if so.
Finding value_corpus_finding() {
  Finding finding{.statement = "corpus",
                  .claim = "the verdict on values without an exact solution is right",
                  .subject = "values",
                  .check = "verdict",
                  .quantity = "1 if the verdict is right",
                  .test = Test::bounds,
                  .variable = "entry",
                  .promised = Verdict::holds,
                  .expected = Verdict::holds};
  for (const ValueEntry& entry : value_corpus()) {
    const Verdict verdict = judge_values(entry.values, entry.theory_order).verdict;
    const bool right = std::find(entry.right.begin(), entry.right.end(), verdict) != entry.right.end();
    finding.points.push_back({.variable = static_cast<double>(finding.points.size() + 1),
                              .value = right ? 1.0 : 0.0,
                              .lower = 1.0,
                              .upper = 1.0,
                              .label = fmt::format("{}: {}", entry.name, name_of(verdict))});
  }
  return finding;
}

/// The band for the share of 95 % intervals that contain the true order.
constexpr double lowest_coverage = 0.93, highest_coverage = 0.97;

Finding coverage_finding(const std::string& subject, const std::string& check, const std::vector<CoverageRow>& rows) {
  Finding finding{.statement = "coverage",
                  .claim = "the 95 % interval contains the true order 93 to 97 % of the time",
                  .subject = subject,
                  .check = check,
                  .quantity = "share of intervals that contain the true order",
                  .test = Test::bounds,
                  .variable = "levels",
                  .promised = Verdict::holds,
                  .expected = Verdict::holds};
  for (const CoverageRow& row : rows) {
    finding.points.push_back({.N = static_cast<std::int64_t>(row.trials),
                              .variable = static_cast<double>(row.levels),
                              .value = row.fraction(),
                              .lower = lowest_coverage,
                              .upper = highest_coverage});
  }
  return finding;
}

std::vector<CoverageRow> of_class(const std::string& name, std::vector<CoverageRow> rows) {
  std::erase_if(rows, [&](const CoverageRow& row) { return row.series != name; });
  return rows;
}

/// Coverage on sequences of values, all together.
Finding value_coverage_finding(const std::string& subject, const std::vector<ValueCoverageRow>& rows,
                               std::size_t ValueCoverageRow::*covered) {
  CoverageRow sum{"all", 0, 0, 0, 0.0};
  for (const ValueCoverageRow& row : rows) {
    sum.trials += row.trials;
    sum.covered += row.*covered;
  }
  return coverage_finding(subject, fmt::format("{} sequences of values", sum.trials), {sum});
}

/// All rows as one, its `levels` being 0.
CoverageRow together(const std::vector<CoverageRow>& rows) {
  CoverageRow sum{"all", 0, 0, 0, 0.0};
  for (const CoverageRow& row : rows) {
    sum.trials += row.trials;
    sum.covered += row.covered;
  }
  return sum;
}

void read_corpus(const Table&, Study& study) {
  for (const CorpusEntry& entry : verdict_corpus()) {
    Finding finding = corpus_finding(entry);
    const std::string name = finding.label();
    study.measurements.push_back({name, [prepared = std::move(finding)](const auto&) {
                                    Finding measured = prepared;
                                    judge(measured);
                                    return measured;
                                  }});
  }
  study.measurements.push_back({value_corpus_finding().label(), [](const auto&) {
                                  Finding finding = value_corpus_finding();
                                  judge(finding);
                                  return finding;
                                }});
}

void read_coverage(const Table& root, Study& study) {
  const Table table = root.sub_table("coverage");
  const auto series = table.whole("series", table.need("series", "series = 10000"), 100, 10'000'000);
  const auto seed = static_cast<std::uint64_t>(table.whole("seed", table.need("seed", "seed = 1"), 0, 1'000'000'000));
  // One row a class and number of levels; known without drawing anything.
  const std::size_t rows = interval_coverage(0, seed).size();
  const std::size_t trials = (static_cast<std::size_t>(series) + rows - 1) / rows;

  const auto measure = [&](const std::string& name, auto take) {
    study.measurements.push_back({name, [take](const auto&) {
                                    Finding finding = take();
                                    judge(finding);
                                    return finding;
                                  }});
  };
  const auto reported = once([=] { return interval_coverage(trials, seed); });
  measure("coverage: reported interval", [=] {
    return coverage_finding("reported interval", fmt::format("{} series", trials * rows), {together(reported())});
  });
  for (const std::string kind : {"power law", "two terms"}) {
    measure("coverage: reported interval, " + kind,
            [=] { return coverage_finding("reported interval", kind, of_class(kind, reported())); });
  }
  for (const double q : {0.5, 2.0}) {
    const std::string name = fmt::format("two terms, correction v^{}", q);
    measure("coverage: reported interval, " + name, [=] {
      return coverage_finding("reported interval", name, interval_coverage(trials, seed, q, "two terms"));
    });
  }
  measure("coverage: interval of the power law, uncorrected (control)", [=] {
    const auto all = interval_coverage(trials, seed, [](LevelView levels) { return fit_power_law(levels); });
    Finding finding = coverage_finding("power law alone (control)", "all series", {together(all)});
    finding.expected = Verdict::violated;
    finding.remark = "An interval that takes no correction into account misses the order of most series that have one.";
    return finding;
  });
  // These take a hundred times as long as errors do, and are fewer.
  const std::size_t value_trials = (trials + 9) / 10;
  const auto values = once([=] { return value_coverage(value_trials, seed); });
  measure("coverage: order of values",
          [=] { return value_coverage_finding("order of values", values(), &ValueCoverageRow::order_covered); });
  measure("coverage: extrapolated value",
          [=] { return value_coverage_finding("extrapolated value", values(), &ValueCoverageRow::limit_covered); });
  measure("coverage: extrapolated value of the law without correction (control)", [=] {
    Finding finding =
        value_coverage_finding("extrapolated value without correction (control)",
                               value_coverage(value_trials, seed, fit_value_law), &ValueCoverageRow::limit_covered);
    finding.expected = Verdict::violated;
    finding.remark = "An interval that takes no correction into account misses the limit of most values that have one.";
    return finding;
  });
}

constexpr Key coverage_keys[] = {
    {"series", "whole number", "how many are drawn, at least"},
    {"seed", "whole number", "of the draw"},
};
constexpr TableKeys coverage_tables[] = {{"[coverage]", coverage_keys}};

}  // namespace

const Kind corpus_kind{"corpus", "verdicts on synthetic series whose right verdict is known", {}, read_corpus};
const Kind coverage_kind{"coverage", "how often the 95 % interval contains the true order", coverage_tables,
                         read_coverage};

}  // namespace acstudy
