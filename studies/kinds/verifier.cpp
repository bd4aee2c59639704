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

Measurement verdict_on(const CorpusEntry& entry) {
  return {{.statement = "corpus",
           .claim = entry.why,
           .subject = entry.name,
           .coordinates = {{"of", "verdict"}},
           .quantity = "synthetic error",
           .test = Test::order,
           .variable = "v",
           .theory_order = entry.theory_order,
           .promised = entry.right.front(),
           .expected = entry.right.front(),
           .also_expected = {entry.right.begin() + 1, entry.right.end()},
           .known = entry.options},
          [levels = entry.levels](Finding& finding) {
            for (const Level& level : levels) {
              finding.points.push_back({.variable = level.variable, .value = level.error});
            }
          }};
}

/// Whether the verdict on each sequence of values is right: a point of value 1 if so.
void judge_all_values(Finding& finding) {
  for (const ValueEntry& entry : value_corpus()) {
    const Verdict verdict = judge_values(entry.values, entry.theory_order).verdict;
    const bool right = std::find(entry.right.begin(), entry.right.end(), verdict) != entry.right.end();
    finding.points.push_back({.variable = static_cast<double>(finding.points.size() + 1),
                              .value = right ? 1.0 : 0.0,
                              .lower = 1.0,
                              .upper = 1.0,
                              .label = fmt::format("{}: {}", entry.name, name_of(verdict))});
  }
}

/// The band for the share of 95 % intervals that contain the true order.
constexpr double lowest_coverage = 0.93, highest_coverage = 0.97;

using Rows = std::vector<CoverageRow>;

Measurement coverage(const std::string& subject, const std::string& series, std::function<Rows()> rows) {
  return {{.statement = "coverage",
           .claim = "the 95 % interval contains the true order 93 to 97 % of the time",
           .subject = subject,
           .coordinates = {{"series", series}},
           .quantity = "share of intervals that contain the true order",
           .variable = "levels"},
          [rows = std::move(rows)](Finding& finding) {
            for (const CoverageRow& row : rows()) {
              finding.points.push_back({.N = static_cast<std::int64_t>(row.trials),
                                        .variable = static_cast<double>(row.levels),
                                        .value = row.fraction(),
                                        .lower = lowest_coverage,
                                        .upper = highest_coverage});
            }
          }};
}

std::vector<CoverageRow> of_class(const std::string& name, std::vector<CoverageRow> rows) {
  std::erase_if(rows, [&](const CoverageRow& row) { return row.series != name; });
  return rows;
}

/// All rows as one, its `levels` being 0.
template <class Row>
CoverageRow together(const std::vector<Row>& rows, std::size_t Row::*covered) {
  CoverageRow sum{"all", 0, 0, 0, 0.0};
  for (const Row& row : rows) {
    sum.trials += row.trials;
    sum.covered += row.*covered;
  }
  return sum;
}

void read_corpus(const Table&, Study& study) {
  for (const CorpusEntry& entry : verdict_corpus()) study.measurements.push_back(verdict_on(entry));
  study.measurements.emplace_back(Check{.statement = "corpus",
                                        .claim = "the verdict on values without an exact solution is right",
                                        .subject = "values",
                                        .coordinates = {{"of", "verdict"}},
                                        .quantity = "1 if the verdict is right",
                                        .variable = "entry"},
                                  judge_all_values);
}

void read_coverage(const Table& root, Study& study) {
  const Table table = root.sub_table("coverage");
  const auto series = table.whole("series", table.need("series", "series = 10000"), 100, 10'000'000);
  const auto seed = static_cast<std::uint64_t>(table.whole("seed", table.need("seed", "seed = 1"), 0, 1'000'000'000));
  // One row a class and number of levels; known without drawing anything.
  const std::size_t rows = interval_coverage(0, seed).size(), value_rows = value_coverage(0, seed).size();
  const std::size_t trials = (static_cast<std::size_t>(series) + rows - 1) / rows;

  std::vector<Measurement>& all = study.measurements;
  const auto reported = once([=] { return interval_coverage(trials, seed); });
  all.push_back(coverage("reported interval", fmt::format("{} series", trials * rows),
                         [=] { return Rows{together(reported(), &CoverageRow::covered)}; }));
  for (const std::string kind : {"power law", "two terms"}) {
    all.push_back(coverage("reported interval", kind, [=] { return of_class(kind, reported()); }));
  }
  for (const double q : {0.5, 2.0}) {
    all.push_back(coverage("reported interval", fmt::format("two terms, correction v^{}", q),
                           [=] { return of_class("two terms", interval_coverage(trials, seed, q)); }));
  }
  const auto be_control = [&](const char* why) {
    all.back().check.expected = Verdict::violated;
    all.back().check.remark = why;
  };
  all.push_back(coverage("power law alone (control)", "all series", [=] {
    const auto uncorrected = [](LevelView levels) { return fit_power_law(levels); };
    return Rows{together(interval_coverage(trials, seed, uncorrected), &CoverageRow::covered)};
  }));
  be_control("An interval that takes no correction into account misses the order of most series that have one.");

  // These take a hundred times as long as errors do, and are fewer.
  const std::size_t value_trials = (trials + 9) / 10;
  const std::string drawn = fmt::format("{} sequences of values", value_trials * value_rows);
  const auto values = once([=] { return value_coverage(value_trials, seed); });
  all.push_back(
      coverage("order of values", drawn, [=] { return Rows{together(values(), &ValueCoverageRow::order_covered)}; }));
  all.push_back(coverage("extrapolated value", drawn,
                         [=] { return Rows{together(values(), &ValueCoverageRow::limit_covered)}; }));
  all.push_back(coverage("extrapolated value without correction (control)", drawn, [=] {
    return Rows{together(value_coverage(value_trials, seed, fit_value_law), &ValueCoverageRow::limit_covered)};
  }));
  be_control("An interval that takes no correction into account misses the limit of most values that have one.");
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
