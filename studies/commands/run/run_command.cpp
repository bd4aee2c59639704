#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>

#include "studies/commands/command.hpp"
#include "studies/commands/exit.hpp"
#include "studies/commands/forecast/forecast.hpp"
#include "studies/commands/output.hpp"
#include "studies/commands/processors.hpp"
#include "studies/commands/run/tell.hpp"
#include "studies/commands/stop.hpp"
#include "studies/kinds/study_file.hpp"
#include "studies/reading/toml_table.hpp"
#include "studies/running/stopwatch.hpp"

namespace acstudy {

namespace {

/// "K/N"
Shard read_shard(const std::string& text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, shard.number);
  const bool slash = number.ec == std::errc() && number.ptr != end && *number.ptr == '/';
  const auto count = slash ? std::from_chars(number.ptr + 1, end, shard.count) : number;
  constexpr int most = 100'000;
  if (!slash || count.ec != std::errc() || count.ptr != end || shard.number < 1 || shard.number > shard.count ||
      shard.count > most) {
    throw InputError(
        fmt::format("--shard: {}; write the number of a share and how many there are, as in 3/16, from 1/1 "
                    "to {}/{}",
                    in_quotes(text), most, most));
  }
  return shard;
}

/// What a share has come to; verdicts are for whoever merges.
int tell_share(const RunResult& result, const RunOptions& options) {
  if (!options.quiet) {
    fmt::print(
        "share {}: {} cases and {} findings computed, {} taken from the store; acstudy merge {} joins the shares\n",
        options.shard.label(), result.computed, result.findings, result.reused, options.out.string());
  }
  return done;
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
  const int status = options.shard.whole() ? tell(result, seconds, options, verbose) : tell_share(result, options);
  return ended(result, status, "finished cases are stored, and the same command goes on from them");
}

}  // namespace

Command run_command() {
  struct Arguments {
    std::vector<std::string> files;
    RunOptions options;
    bool verbose = false;
    std::string out = options.out.string(), form = "vector";
    std::optional<std::string> shard;
  };
  const auto a = std::make_shared<Arguments>();
  a->options.jobs = available_processors();
  return {
      "run",
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
       {.name = "--shard",
        .target = &a->shard,
        .help = "do the K-th of N shares of about equal work; acstudy merge joins them",
        .type = "K/N"},
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
        if (a->shard) a->options.shard = read_shard(*a->shard);
        a->options.command = command_line;
        return run(a->files, a->options, a->verbose);
      },
      {{"run studies/fig1.toml", "the first figure of the paper; results in reports/out"},
       {"run -v my-study.toml --out out --jobs 2", "a study of your own, with a table of its series"},
       {"run my-study.toml --out out --shard 3/16", "the third of sixteen shares, as another machine does another"}}};
}

}  // namespace acstudy
