#include "studies/commands/check.hpp"

#include <fmt/format.h>

#include <cmath>

namespace acstudy {

std::string observed_text(const Judgement& judgement) {
  if (std::isnan(judgement.order)) return "-";
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", judgement.order, judgement.low, judgement.high);
}

std::string expected_text(const Finding& finding) {
  std::string text(name_of(finding.expected));
  for (const Verdict also : finding.also_expected) text += fmt::format(" or {}", name_of(also));
  return text;
}

Row row_of(const std::string& study, const Finding& finding) {
  return {.study = study,
          .name = finding.label(),
          .observed = observed_text(finding.judgement),
          .verdict = std::string(name_of(finding.judgement.verdict)),
          .expected = expected_text(finding),
          .reason = finding.judgement.reason,
          .passes = finding.as_expected()};
}

std::vector<Row> check_file(const std::string& file) {
  std::vector<Row> rows;
  const ResultRecord all = read_json(file);
  for (const FindingRecord& record : all.findings) {
    Row& row = rows.emplace_back(row_of(all.study, record.finding));
    row.file = file;
    if (record.verdict != row.verdict) {
      row.passes = false;
      row.reason = fmt::format("the file says {}, but its numbers say otherwise: {}", record.verdict, row.reason);
    }
    if (const auto& cases = record.finding.cases; cases && cases->run != cases->planned) {
      row.passes = false;
      row.reason = fmt::format("{} of {} cases; the run was interrupted", cases->run, cases->planned);
    }
  }
  const auto add = [&](const char* name, const char* verdict, const char* expected, const std::string& reason) {
    rows.push_back({.file = file,
                    .study = all.study,
                    .name = name,
                    .observed = "-",
                    .verdict = verdict,
                    .expected = expected,
                    .reason = reason,
                    .passes = false});
  };
  if (all.findings.size() != all.findings_planned) {
    const std::string reason =
        fmt::format("{} of {} findings; the run was interrupted", all.findings.size(), all.findings_planned);
    add("all findings", "inconclusive", "a whole run", reason);
  }
  // Where something departs anyway, that is what there is to look at.
  if (all.damaged && departing_in(rows) == 0) {
    add("the file", "damaged", "a file as it was written",
        "its checksum is not that of its values: it was damaged or edited; run the study again");
  }
  return rows;
}

}  // namespace acstudy
