#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include "studies/commands/bench/bench.hpp"
#include "studies/commands/command.hpp"
#include "studies/commands/exit.hpp"
#include "studies/commands/output.hpp"
#include "studies/commands/say.hpp"
#include "studies/commands/stop.hpp"
#include "studies/commands/terminal.hpp"
#include "studies/kinds/study_file.hpp"
#include "studies/running/run_case.hpp"
#include "studies/storing/bench_store.hpp"
#include "studies/storing/files.hpp"
#include "studies/storing/study_lock.hpp"

namespace acstudy {

namespace {

struct BenchRequest {
  std::filesystem::path out = "reports/out/bench";
  BenchOptions options;
  bool fresh = false;  ///< drop the samples of an earlier bench
  bool quiet = false;  ///< show no progress and no count
  std::string command;
};

struct BenchResult {
  BenchOutcome outcome;
  std::size_t cases = 0;  ///< distinct
  double seconds = 0.0;   ///< that all of it took
  bool complete = false;  ///< every case that has a solution has its number of runs and its time
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A line on the terminal that is rewritten; silent where stderr is none.
void show_progress(std::int64_t round, std::size_t open, std::size_t cases) {
  const std::string line = fmt::format("\r\033[Kround {}, {} of {} cases need more runs", round, open, cases);
  std::fputs(open > 0 ? line.c_str() : "\r\033[K", stderr);
  std::fflush(stderr);
}

/// Times the cases of convergence studies one at a time and keeps the samples in `request.out`: at the end, when `stop`
/// becomes true, and about once a second, so that nothing that kills the program costs more.
/// @throws InputError, StoreError
BenchResult bench_studies(const std::vector<Study>& studies, const BenchRequest& request,
                          const std::atomic<bool>& stop) {
  const StudyLock lock(request.out, "bench");
  if (!lock.without().empty()) {
    say(fmt::format("note: {}: this file system has no locks ({}); see that no other bench writes there",
                    request.out.string(), lock.without()));
  }
  remove_partial(request.out, {"bench.h5", "bench.json"});
  Bench bench = plan_bench(studies, request.options.threads);
  std::map<const Case*, Plan> plans;
  for (BenchCase& one : bench.cases) one.form = plans.try_emplace(one.c, plan(*one.c)).first->second.form->name;
  if (!request.fresh) take_up_bench(request.out, bench);
  const Provenance provenance = collect_provenance(1, request.command);
  const auto write = [&](bool complete) { write_bench(request.out, bench, request.options, provenance, complete); };

  const auto start = std::chrono::steady_clock::now();
  auto written = start;
  const bool shown = on_terminal(Stream::error) && !request.quiet;
  const auto run = [&](const Case& c, int threads) { return run_cases({&plans.at(&c), 1}, stop, 1, threads).front(); };
  const BenchHooks hooks = {.run = run, .after_round = [&](std::int64_t round, std::size_t open) {
                              if (shown) show_progress(round, open, bench.cases.size());
                              if (seconds_since(written) < 1.0) return;
                              write(false);
                              written = std::chrono::steady_clock::now();
                            }};
  BenchResult result{.outcome = time_cases(bench, request.options, hooks, stop), .cases = bench.cases.size()};
  result.complete = !stop && result.outcome.departs.empty();
  result.seconds = seconds_since(start);
  write(result.complete);
  return result;
}

int bench(const std::vector<std::string>& files, const BenchRequest& request) {
  const std::vector<Study> studies = read_studies(files);
  plan_bench(studies, request.options.threads);  // refuses what it cannot time before anything is written
  prepare_folder(request.out);
  const std::atomic<bool>& stop = stop_on_signals();
  const BenchResult result = bench_studies(studies, request, stop);
  if (!request.quiet) {
    fmt::print("{} cases, {} timed runs in {:.1f} s; samples in {}\n", result.cases, result.outcome.runs,
               result.seconds, request.out.string());
  }
  for (const std::string& what : result.outcome.departs) say("two runs of one case differ: " + what);
  for (const std::string& what : result.outcome.failed) say("not timed, it has no solution: " + what);
  if (stop) {
    say("interrupted; finished runs are stored, and the same command goes on from them");
    return interrupted;
  }
  return !result.outcome.departs.empty() ? departs : !result.outcome.failed.empty() ? numerical_failure : done;
}

}  // namespace

Command bench_command() {
  struct Arguments {
    std::vector<std::string> files;
    BenchRequest request;
    std::string out = request.out.string();
  };
  const auto a = std::make_shared<Arguments>();
  return {"bench",
          "Time the cases of convergence studies, each alone, in turn with all others; exit 1 if two runs of one "
          "case differ in error or work",
          {{.name = "STUDY.toml", .target = &a->files, .help = "study files", .required = true},
           {.name = "--out", .target = &a->out, .help = "folder for DIR/bench.h5 and DIR/bench.json", .type = "DIR"},
           {.name = "--runs",
            .target = &a->request.options.runs,
            .help = "least number of timed runs of a case",
            .type = "N",
            .range = {{1, most_runs}}},
           {.name = "--least-seconds",
            .target = &a->request.options.least_seconds,
            .help = fmt::format("least time of the timed runs of a case in all; {} runs do", most_runs),
            .type = "S",
            .range = {{0.0, 3600.0}}},
           {.name = "--threads",
            .target = &a->request.options.threads,
            .help = "threads that share the work of a case; several numbers, as in 1,2, time each case with each",
            .type = "N,...",
            .range = {{1, 1024}}},
           {.name = "--fresh", .target = &a->request.fresh, .help = "drop the samples of an earlier bench in DIR"},
           quiet_option(&a->request.quiet, "print neither progress nor counts")},
          [a](const std::string& command_line) {
            a->request.out = a->out;
            a->request.command = command_line;
            return bench(a->files, a->request);
          },
          {{"bench studies/fig1.toml", "times the cases of a study; samples in reports/out/bench"},
           {"bench studies/fig5.toml --threads 1,2 --out out", "each case with one thread and with two"}}};
}

}  // namespace acstudy
