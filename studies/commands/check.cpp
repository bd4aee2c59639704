#include "studies/commands/check.hpp"

#include <fmt/format.h>

#include <cmath>

#include "studies/running/reference.hpp"

namespace acstudy {

namespace {

/// The row of a judgement; `stated` is the verdict in the file.
Row row_of(const std::string& file, const std::string& study, const std::string& name, const Judgement& judgement,
           bool as_expected, const std::string& expected, const std::string& stated) {
  const std::string verdict(name_of(judgement.verdict));
  Row row{.file = file,
          .study = study,
          .name = name,
          .observed = observed_text(judgement),
          .verdict = verdict,
          .expected = expected,
          .reason = judgement.reason,
          .passes = as_expected && stated == verdict};
  if (stated != verdict) {
    row.reason = fmt::format("the file says {}, but its numbers say otherwise: {}", stated, judgement.reason);
  }
  return row;
}

Row check_series(const std::string& file, const SeriesRecord& record) {
  Judgement judgement =
      judge_errors(record.levels, record.reference, record.theory_order, {.scale = solution_scale(record.solutions)});
  if (record.expected == Verdict::stable) {
    for (std::size_t i = 0; i < record.levels.size(); ++i) {
      require_bounded(judgement, record.levels[i].error, record.solutions[i]);
    }
  }
  if (!record.failure.empty()) {
    judgement.verdict = Verdict::inconclusive;
    judgement.reason = not_computed(record.failure);
  }
  const bool as_expected =
      meets(judgement.verdict, record.expected) && !(!record.failure.empty() && record.expected == Verdict::stable);
  Row row = row_of(file, record.study, record.label, judgement, as_expected, std::string(name_of(record.expected)),
                   record.verdict);
  if (record.cases_run() != record.cases_planned) {
    row.passes = false;
    row.reason = fmt::format("{} of {} cases; the run was interrupted", record.cases_run(), record.cases_planned);
  }
  return row;
}

}  // namespace

std::string observed_text(const Judgement& judgement) {
  if (std::isnan(judgement.order)) return "-";
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", judgement.order, judgement.low, judgement.high);
}

std::string expected_text(const Finding& finding) {
  std::string text(name_of(finding.expected));
  for (const Verdict also : finding.also_expected) text += fmt::format(" or {}", name_of(also));
  return text;
}

std::vector<Row> check_file(const std::string& file) {
  std::vector<Row> rows;
  const ResultRecord all = read_json(file);
  for (const SeriesRecord& record : all.series) rows.push_back(check_series(file, record));
  for (const FindingRecord& record : all.findings) {
    const Finding& finding = record.finding;
    rows.push_back(row_of(file, record.study, finding.label(), finding.judgement, finding.as_expected(),
                          expected_text(finding), record.verdict));
  }
  if (all.findings.size() != all.findings_planned) {
    const std::string reason =
        fmt::format("{} of {} findings; the run was interrupted", all.findings.size(), all.findings_planned);
    rows.push_back({.file = file,
                    .study = all.study,
                    .name = "all findings",
                    .observed = "-",
                    .verdict = "inconclusive",
                    .expected = "a whole run",
                    .reason = reason,
                    .passes = false});
  }
  return rows;
}

}  // namespace acstudy
