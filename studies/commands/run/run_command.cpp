#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <memory>
#include <thread>

#include "studies/commands/command.hpp"
#include "studies/commands/exit.hpp"
#include "studies/commands/forecast/forecast.hpp"
#include "studies/commands/output.hpp"
#include "studies/commands/run/summary.hpp"
#include "studies/commands/say.hpp"
#include "studies/commands/stop.hpp"
#include "studies/commands/terminal.hpp"
#include "studies/kinds/study_file.hpp"
#include "studies/running/stopwatch.hpp"

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

int run(const std::vector<std::string>& files, const RunOptions& options, bool verbose) {
  std::vector<Study> studies = read_studies(files);
  if (options.readable) {
    for (Study& study : studies) {
      for (Series& series : study.series) {
        for (Case& c : series.cases) c.readable = c.scheme.program == nullptr;
      }
    }
  }
  require_memory(studies);
  prepare_folder(options.out);
  double seconds = 0.0;
  RunResult result;
  timed(seconds, [&] { result = run_studies(studies, options, stop_on_signals()); });
  const RunSummary summary = summarize(result, seconds, options.out.string());
  constexpr std::size_t most_lines = 25, most_notes = 3;
  const std::size_t width = columns(Stream::out);
  if (options.quiet) {
    fmt::print("{}", departures_text(summary, width, most_lines));
  } else {
    const std::vector<std::string> notes = steps_beyond_bounds(result.studies, most_notes);
    for (const std::string& note : notes) say("note: " + note);
    fmt::print("{}{}", verbose ? table_text(summary.rows, table_width()) + adaptive_steps_text(result.studies) : "",
               summary_text(summary, width, most_lines - 2 * notes.size()));
  }
  if (!result.interrupted) return summary.status;
  say("interrupted; finished cases are stored, and the same command goes on from them");
  return interrupted;
}

}  // namespace

Command run_command() {
  struct Arguments {
    std::vector<std::string> files;
    RunOptions options;
    bool verbose = false;
    std::string out = options.out.string(), form = "vector";
  };
  const auto a = std::make_shared<Arguments>();
  a->options.jobs = available_processors();
  return {"run",
          "Run every case of the studies that is not stored yet; exit 1 if a verdict departs",
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
            .one_of = {"vector", "readable"}},
           quiet_option(&a->options.quiet, "print only what departs, and no progress"),
           verbose_option(&a->verbose, "print a table of every series as well")},
          [a](const std::string& command_line) {
            a->options.out = a->out;
            a->options.readable = a->form == "readable";
            a->options.command = command_line;
            return run(a->files, a->options, a->verbose);
          },
          {{"run studies/fig1.toml", "the first figure of the paper; results in reports/out"},
           {"run -v my-study.toml --out out --jobs 2", "a study of your own, with a table of its series"}}};
}

}  // namespace acstudy
