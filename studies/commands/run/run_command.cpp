#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <memory>
#include <thread>

#include "studies/commands/check.hpp"
#include "studies/commands/command.hpp"
#include "studies/commands/exit.hpp"
#include "studies/commands/output.hpp"
#include "studies/commands/run/runner.hpp"
#include "studies/commands/say.hpp"
#include "studies/commands/stop.hpp"
#include "studies/kinds/study_file.hpp"

namespace acstudy {

namespace {

/// Processors that this process may use, which a container or batch system can make fewer than the machine has.
int available_processors() {
#ifdef __linux__
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
#endif
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

/// What a run says of its studies: a row per gate, and the exit code.
struct Outcome {
  std::vector<Row> rows;
  int status = done;
};

/// Findings are many: `run` shows those that depart, `check` all.
void add_findings(Outcome& outcome, const StudyResult& study, bool interrupted_run) {
  bool all_pass = true;
  for (const auto& finding : study.findings) {
    if (!finding || finding->as_expected()) continue;
    all_pass = false;
    const Verdict verdict = finding->judgement.verdict;
    outcome.rows.push_back({.study = study.study->name,
                            .name = finding->label(),
                            .observed = observed_text(finding->judgement),
                            .verdict = std::string(name_of(verdict)),
                            .expected = expected_text(*finding),
                            .reason = finding->judgement.reason,
                            .passes = false});
    const bool failed = !finding->failure.empty() || verdict == Verdict::unstable;
    outcome.status = std::max<int>(outcome.status, failed ? numerical_failure : departs);
  }
  if (!all_pass || interrupted_run) return;
  outcome.rows.push_back({.study = study.study->name,
                          .name = fmt::format("{} findings", study.findings.size()),
                          .observed = "-",
                          .verdict = "as expected",
                          .passes = true});
}

void add_series(Outcome& outcome, const StudyResult& study, bool interrupted_run) {
  for (const SeriesResult& series : study.series) {
    if (interrupted_run && series.completed().size() < series.results.size()) continue;
    const bool passes = series.as_expected();
    outcome.rows.push_back({.study = study.study->name,
                            .name = series.series->label(),
                            .observed = observed_text(series.judgement),
                            .verdict = std::string(name_of(series.judgement.verdict)),
                            .expected = std::string(name_of(series.series->expected)),
                            .reason = series.judgement.reason,
                            .passes = passes});
    if (passes) continue;
    const bool failed = series.failed() || series.judgement.verdict == Verdict::unstable;
    outcome.status = std::max<int>(outcome.status, failed ? numerical_failure : departs);
  }
}

/// Says which series took steps beyond the bound of their lemma, and where that began in its worst case. Steps that
/// follow the rows' bound mean to.
void note_steps_beyond_bounds(const std::vector<StudyResult>& studies) {
  for (const StudyResult& study : studies) {
    if (!study.study->judged_by_series()) continue;
    for (const SeriesResult& result : study.series) {
      const std::vector<Case>& cases = result.series->cases;
      std::size_t worst = 0;
      for (std::size_t i = 1; i < cases.size(); ++i) {
        if (result.results[i].against_bound.largest > result.results[worst].against_bound.largest) worst = i;
      }
      const StepsAgainstBound& bound = result.results[worst].against_bound;
      if (bound.first_step == 0 || cases[worst].step.bound == StepRule::Bound::rows) continue;
      say(
          fmt::format("note: {}: {}, N = {}: from step {} on (t = {:.4g}, smallest gap at x = {:.6g}) steps are beyond "
                      "the bound of {}, by a factor of up to {:.3g}",
                      study.study->name, result.series->label(), cases[worst].N, bound.first_step, bound.first_time,
                      bound.first_place, result.series->scheme.model->step_lemma.name, bound.largest));
    }
  }
}

int run(const std::vector<std::string>& files, const RunOptions& options) {
  std::vector<Study> studies = read_studies(files);
  if (options.readable) {
    for (Study& study : studies) {
      for (Series& series : study.series) {
        for (Case& c : series.cases) c.readable = true;
      }
    }
  }
  prepare_folder(options.out);
  const RunResult result = run_studies(studies, options, stop_on_signals());
  Outcome outcome;
  for (const StudyResult& study : result.studies) {
    (study.study->judged_by_series() ? add_series : add_findings)(outcome, study, result.interrupted);
  }
  fmt::print("{}{} cases computed, {} taken from the store; results in {}\n", table_text(outcome.rows), result.computed,
             result.reused, options.out.string());
  note_steps_beyond_bounds(result.studies);
  if (!result.interrupted) return outcome.status;
  say("interrupted; finished cases are stored, and the same command goes on from them");
  return interrupted;
}

}  // namespace

Command run_command() {
  struct Arguments {
    std::vector<std::string> files;
    RunOptions options;
    std::string out = options.out.string(), form = "vector";
  };
  const auto a = std::make_shared<Arguments>();
  a->options.jobs = available_processors();
  return {"run",
          "Run every case of the studies that is not stored yet",
          {{.name = "STUDY.toml", .target = &a->files, .help = "study files", .required = true},
           {.name = "--out", .target = &a->out, .help = "folder for DIR/<study>.h5 and .json", .type = "DIR"},
           {.name = "--jobs",
            .target = &a->options.jobs,
            .help = "cases run at the same time; numbers do not depend on it",
            .type = "N",
            .range = {{1, 1024}}},
           {.name = "--repeats",
            .target = &a->options.repeats,
            .help = "run each case at least N times, for its run time and spread",
            .type = "N",
            .range = {{1, 1000}}},
           {.name = "--fresh", .target = &a->options.fresh, .help = "run stored cases again"},
           {.name = "--form",
            .target = &a->form,
            .help = "vector: several particles at a time, weights never stored; readable: its reference",
            .type = "NAME",
            .one_of = {"vector", "readable"}}},
          [a](const std::string& command_line) {
            a->options.out = a->out;
            a->options.readable = a->form == "readable";
            a->options.command = command_line;
            return run(a->files, a->options);
          }};
}

}  // namespace acstudy
