#include "studies/commands/bench/bench_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>

#include "studies/running/run_case.hpp"
#include "studies/storing/bench_store.hpp"

namespace acstudy {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A line on the terminal that is rewritten; silent where stderr is none.
void show_progress(std::int64_t round, std::size_t open, std::size_t cases) {
  const std::string line = fmt::format("\r\033[Kround {}, {} of {} cases need more runs", round, open, cases);
  std::fputs(open > 0 ? line.c_str() : "\r\033[K", stderr);
  std::fflush(stderr);
}

}  // namespace

BenchResult bench_studies(const std::vector<Study>& studies, const BenchRequest& request,
                          const std::atomic<bool>& stop) {
  Bench bench = plan_bench(studies, request.options.threads);
  if (!request.fresh) take_up_bench(request.out, bench);
  const Provenance provenance = collect_provenance(1, request.command);
  const auto write = [&](bool complete) { write_bench(request.out, bench, request.options, provenance, complete); };

  const auto start = std::chrono::steady_clock::now();
  auto written = start;
  const bool on_terminal = isatty(STDERR_FILENO) != 0;
  const BenchHooks hooks = {.run = [&](const Case& c, int threads) { return run_case(c, stop, 1, threads); },
                            .after_round =
                                [&](std::int64_t round, std::size_t open) {
                                  if (on_terminal) show_progress(round, open, bench.cases.size());
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

}  // namespace acstudy
