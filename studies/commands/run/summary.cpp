#include "studies/commands/run/summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "studies/commands/check.hpp"
#include "studies/commands/exit.hpp"
#include "studies/commands/seconds.hpp"
#include "studies/commands/terminal.hpp"

namespace acstudy {

namespace {

/// Findings are many: those that depart have rows, and those with cases of their own.
void add_findings(RunSummary& summary, const StudyResult& study, bool interrupted_run) {
  bool all_have_rows = false, all_pass = true;
  for (const auto& finding : study.findings) {
    if (!finding) continue;
    const bool of_series = finding->cases.has_value();
    if (of_series && interrupted_run && finding->cases->run < finding->cases->planned) continue;
    ++summary.verdicts[std::string(name_of(finding->judgement.verdict))];
    const bool passes = finding->as_expected();
    all_have_rows = all_have_rows || of_series;
    all_pass = all_pass && passes;
    if (passes && !of_series) continue;
    summary.rows.push_back(row_of(study.study->name, *finding));
    if (passes) continue;
    const bool failed = !finding->failure.empty() || finding->judgement.verdict == Verdict::unstable;
    summary.status = std::max<int>(summary.status, failed ? numerical_failure : departs);
  }
  if (all_have_rows || !all_pass || interrupted_run) return;
  summary.rows.push_back({.study = study.study->name,
                          .name = fmt::format("{} findings", study.findings.size()),
                          .observed = "-",
                          .verdict = "as expected",
                          .passes = true});
}

std::string counted(std::size_t count, const char* one, const char* several) {
  return fmt::format("{} {}", count, count == 1 ? one : several);
}

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// "3353 findings of 33 studies, all as expected: 1892 holds, 1004 confirmed"
std::string verdicts_text(const RunSummary& summary, std::size_t width) {
  std::vector<std::pair<std::size_t, std::string>> counts;
  std::size_t all = 0;
  for (const auto& [verdict, count] : summary.verdicts) {
    counts.emplace_back(count, verdict);
    all += count;
  }
  std::stable_sort(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  if (all == 0) return "";  // interrupted before the first
  std::vector<std::string> said;
  for (const auto& [count, verdict] : counts) said.push_back(fmt::format("{} {}", count, verdict));
  const std::size_t departing = departing_in(summary.rows);
  const std::string judgement = departing == 0   ? "all as expected"
                                : departing == 1 ? "1 departs"
                                                 : fmt::format("{} depart", departing);
  std::string text =
      wrapped(fmt::format("{} of {}, {}: {}", counted(all, "finding", "findings"),
                          counted(summary.studies, "study", "studies"), judgement, fmt::join(said, ", ")),
              width, 2);
  if (const std::size_t at = text.find(judgement); at != std::string::npos) {
    text.replace(at, judgement.size(), colored(judgement, departing > 0 ? Color::red : Color::green));
  }
  return text + "\n";
}

/// "92 s; longest, in time of a processor: map 34 s, controls 21 s"; empty where that is of no interest.
std::string slowest_text(const RunSummary& summary, std::size_t width) {
  if (summary.seconds < (summary.studies < 2 ? 10.0 : 1.0)) return "";
  auto slowest = summary.by_study;
  std::erase_if(slowest, [](const auto& one) { return one.second < 0.1; });
  std::stable_sort(slowest.begin(), slowest.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  constexpr std::size_t most = 5;
  if (slowest.size() > most) slowest.resize(most);
  std::vector<std::string> said;
  for (const auto& [study, seconds] : slowest) said.push_back(fmt::format("{} {}", study, seconds_text(seconds)));
  const std::string all = seconds_text(summary.seconds);
  if (summary.studies < 2 || said.empty()) return all + " in all\n";
  return wrapped(fmt::format("{}; longest, in time of a processor: {}", all, fmt::join(said, ", ")), width, 2) + "\n";
}

std::string results_text(const RunSummary& summary, std::size_t width) {
  return wrapped(fmt::format("{} cases computed, {} taken from the store; results in {}", summary.computed,
                             summary.reused, summary.out),
                 width, 2) +
         "\n";
}

/// How all departures are seen: by the result files of a few studies, or by those of all.
std::string command_for_all(const RunSummary& summary) {
  std::set<std::string> files;
  for (const Row& row : summary.rows) {
    if (!row.passes) files.insert(fmt::format("{}/{}.json", summary.out, row.study));
  }
  if (files.size() > 2) files = {summary.out + "/*.json"};
  return fmt::format("acstudy check {}", fmt::join(files, " "));
}

}  // namespace

RunSummary summarize(const RunResult& result, double seconds, const std::string& out) {
  RunSummary summary{.status = done,
                     .studies = result.studies.size(),
                     .computed = result.computed,
                     .reused = result.reused,
                     .out = out};
  summary.seconds = seconds;
  for (std::size_t s = 0; s < result.studies.size(); ++s) {
    add_findings(summary, result.studies[s], result.interrupted);
    summary.by_study.emplace_back(result.studies[s].study->name, result.seconds[s]);
  }
  return summary;
}

std::string departures_text(const RunSummary& summary, std::size_t width, std::size_t most) {
  const std::size_t all = departing_in(summary.rows);
  const std::string command = command_for_all(summary);
  const auto rest = [&](std::size_t count) {
    return count == 0 ? "" : wrapped(fmt::format("... and {} more; all of them: {}", count, command), width, 4) + "\n";
  };
  std::string text;
  std::size_t shown = 0;
  for (const Row& row : summary.rows) {
    if (row.passes) continue;
    const std::string with_it = text + record_text(row, width);
    if (lines_of(with_it + rest(all - shown - 1)) > most) break;
    text = with_it;
    ++shown;
  }
  return text + rest(all - shown);
}

std::string summary_text(const RunSummary& summary, std::size_t width, std::size_t most) {
  const std::string end = verdicts_text(summary, width) + slowest_text(summary, width) + results_text(summary, width);
  const std::size_t left = most > lines_of(end) ? most - lines_of(end) : 0;
  return departures_text(summary, width, left) + end;
}

std::vector<std::string> steps_beyond_bounds(const std::vector<StudyResult>& studies, std::size_t most) {
  std::vector<std::string> lines;
  for (const StudyResult& study : studies) {
    std::size_t all = 0, beyond = 0;
    double largest = 0.0;
    std::set<std::string_view> lemmas;
    for (const SeriesResult& series : study.series) {
      ++all;
      double worst = 0.0;
      for (std::size_t i = 0; i < series.results.size(); ++i) {
        const StepsAgainstBound& bound = series.results[i].against_bound;
        const StepRule& rule = series.series->cases[i].step;
        const bool meant = rule.bound == StepRule::Bound::rows || rule.adaptive();
        if (bound.first_step > 0 && !meant) worst = std::max(worst, bound.largest);
      }
      if (worst == 0.0) continue;
      ++beyond;
      largest = std::max(largest, worst);
      lemmas.insert(series.series->scheme.model->step_lemma.name);
    }
    if (beyond == 0) continue;
    lines.push_back(fmt::format("{}: steps of {} of {} series are beyond the bound of {}, by a factor of up to {:.3g}",
                                study.study->name, beyond, all, fmt::join(lemmas, " and "), largest));
  }
  if (lines.size() > most) {
    const std::size_t more = lines.size() - most;
    lines.resize(most);
    lines.push_back(fmt::format("steps of {} more studies are, too; each case's are in the result files", more));
  }
  return lines;
}

std::string adaptive_steps_text(const std::vector<StudyResult>& studies) {
  std::string text;
  for (const StudyResult& study : studies) {
    for (const SeriesResult& series : study.series) {
      if (!series.series->cases.front().step.adaptive()) continue;
      std::vector<std::string> counts;
      for (const std::size_t i : series.completed()) {
        const CaseResult& result = series.results[i];
        counts.push_back(fmt::format("{} + {} at N = {}", result.steps, result.rejected, series.series->cases[i].N));
      }
      text += fmt::format("{}, {}: steps + rejected ones: {}\n", study.study->name, series.series->label(),
                          fmt::join(counts, ", "));
    }
  }
  return text;
}

}  // namespace acstudy
