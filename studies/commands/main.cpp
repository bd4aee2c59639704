/// @file
/// The command line: acstudy run | check | fit | bench | explain | list.

#include <fmt/format.h>
#include <sched.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>
#include <thread>

#include "build_info.hpp"
#include "studies/commands/bench/bench_command.hpp"
#include "studies/commands/check.hpp"
#include "studies/commands/explain.hpp"
#include "studies/commands/fit/fit_values.hpp"
#include "studies/commands/gate.hpp"
#include "studies/commands/list.hpp"
#include "studies/commands/run/runner.hpp"
#include "studies/kinds/study_file.hpp"
#include "studies/storing/files.hpp"
#include "studies/storing/store_error.hpp"

namespace {

using namespace acstudy;
namespace fs = std::filesystem;

enum Exit { done = 0, departs = 1, bad_input = 2, numerical_failure = 3, machine_failure = 4, interrupted = 130 };

std::atomic<bool> stop{false};

extern "C" void on_signal(int) { stop = true; }

/// Processors that this process may use, which a container or batch system can make fewer than the machine has.
int available_processors() {
#ifdef __linux__
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return CPU_COUNT(&set);
#endif
  return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

/// A line on stderr; whether anybody can read it must not matter to the exit code.
void say(const std::string& message) { std::fputs(("acstudy: " + message + "\n").c_str(), stderr); }

/// A real number from `low` to `high`. CLI::Range takes nan for one.
CLI::Validator real_range(double low, double high) {
  return {[low, high](const std::string& text) {
            double value = std::numeric_limits<double>::quiet_NaN();
            CLI::detail::lexical_cast(text, value);
            if (low <= value && value <= high) return std::string();
            return fmt::format("Value {} not in range {:g} to {:g}", text, low, high);
          },
          ""};
}

std::vector<Study> read_studies(const std::vector<std::string>& files) {
  std::vector<Study> studies;
  std::set<std::string> names;
  for (const std::string& file : files) {
    studies.push_back(read_study(file));
    if (!names.insert(studies.back().name).second) {
      throw InputError(fmt::format("{}: a second study named \"{}\"; it would overwrite the results of the first", file,
                                   studies.back().name));
    }
  }
  return studies;
}

/// What keeps a file from being made in a folder; empty if nothing does.
std::string why_not_writable(const fs::path& folder) {
  const fs::path probe = folder / ".acstudy-writable";
  std::FILE* const file = std::fopen(probe.c_str(), "w");
  if (file == nullptr) return std::strerror(errno);
  std::fclose(file);
  std::error_code ignored;
  fs::remove(probe, ignored);
  return "";
}

/// Makes the output folder and tries it, before hours of work depend on it.
void prepare_folder(const fs::path& out) {
  std::error_code error;
  fs::create_directories(out, error);
  if (const std::string why = error ? error.message() : why_not_writable(out); !why.empty()) {
    throw InputError(
        fmt::format("{}: cannot write to the output folder: {}; name another one with --out", out.string(), why));
  }
}

/// Throws unless the file can be written. It will be replaced as a whole, which no device or folder must be, and no
/// result file: in `--junit *.json` the shell names the first of them.
void require_writable(const fs::path& file) {
  std::error_code ignored;
  const bool replaceable = !fs::exists(file, ignored) || fs::is_regular_file(file, ignored);
  std::string why;
  if (!file.has_filename()) {
    why = "it has no name";
  } else if (file.extension() == ".json") {
    why = "a result file has such a name";
  } else if (!replaceable) {
    why = "there is something that is no regular file";
  } else {
    why = why_not_writable(file.parent_path().empty() ? "." : file.parent_path());
  }
  if (why.empty()) return;
  throw InputError(
      fmt::format("{}: cannot write the JUnit file: {}; name another one with --junit", file.string(), why));
}

/// Findings are many: `run` shows those that depart, `check` all.
std::vector<Row> departing_findings(const StudyResult& study) {
  std::vector<Row> rows;
  for (const auto& finding : study.findings) {
    if (!finding || finding->as_expected()) continue;
    rows.push_back({.study = study.study->name,
                    .name = finding->label(),
                    .observed = observed_text(finding->judgement),
                    .verdict = std::string(name_of(finding->judgement.verdict)),
                    .expected = expected_text(*finding),
                    .reason = finding->judgement.reason,
                    .passes = false});
  }
  return rows;
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

int run(const std::vector<std::string>& files, RunOptions options) {
  std::vector<Study> studies = read_studies(files);
  if (options.readable) {
    for (Study& study : studies) {
      for (Series& series : study.series) {
        for (Case& c : series.cases) c.readable = true;
      }
    }
  }
  prepare_folder(options.out);
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);

  const RunResult result = run_studies(studies, options, stop);
  int status = done;
  std::vector<Row> rows;
  for (const StudyResult& study : result.studies) {
    if (!study.study->judged_by_series()) {
      const std::vector<Row> departing = departing_findings(study);
      rows.insert(rows.end(), departing.begin(), departing.end());
      if (!departing.empty()) {
        const bool failed = std::any_of(study.findings.begin(), study.findings.end(), [](const auto& finding) {
          return finding && !finding->as_expected() &&
                 (!finding->failure.empty() || finding->judgement.verdict == Verdict::unstable);
        });
        status = std::max<int>(status, failed ? numerical_failure : departs);
      } else if (!result.interrupted) {
        rows.push_back({.study = study.study->name,
                        .name = fmt::format("{} findings", study.findings.size()),
                        .observed = "-",
                        .verdict = "as expected",
                        .passes = true});
      }
      continue;
    }
    for (const SeriesResult& series : study.series) {
      if (result.interrupted && series.completed().size() < series.results.size()) continue;
      const bool passes = series.as_expected();
      rows.push_back({.study = study.study->name,
                      .name = series.series->label(),
                      .observed = observed_text(series.judgement),
                      .verdict = std::string(name_of(series.judgement.verdict)),
                      .expected = std::string(name_of(series.series->expected)),
                      .reason = series.judgement.reason,
                      .passes = passes});
      if (!passes) {
        const bool numerical = series.failed() || series.judgement.verdict == Verdict::unstable;
        status = std::max<int>(status, numerical ? numerical_failure : departs);
      }
    }
  }
  fmt::print("{}{} cases computed, {} taken from the store; results in {}\n", table_text(rows), result.computed,
             result.reused, options.out.string());
  note_steps_beyond_bounds(result.studies);
  if (result.interrupted) {
    say("interrupted; finished cases are stored, and the same command goes on from them");
    return interrupted;
  }
  return status;
}

int check(const std::vector<std::string>& files, const std::optional<std::string>& junit, bool github) {
  if (junit) require_writable(*junit);
  std::vector<Row> rows;
  for (const std::string& file : files) {
    for (Row& row : check_file(file)) rows.push_back(std::move(row));
  }
  fmt::print("{}{}{}", table_text(rows), count_text(rows), github ? github_text(rows) : "");
  if (junit) replace_atomically(*junit, junit_text(rows));
  return std::all_of(rows.begin(), rows.end(), [](const Row& row) { return row.passes; }) ? done : departs;
}

int bench(const std::vector<std::string>& files, const BenchRequest& request) {
  const std::vector<Study> studies = read_studies(files);
  plan_bench(studies, request.options.threads);  // refuses what it cannot time before anything is written
  prepare_folder(request.out);
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);

  const BenchResult result = bench_studies(studies, request, stop);
  fmt::print("{} cases, {} timed runs in {:.1f} s; samples in {}\n", result.cases, result.outcome.runs, result.seconds,
             request.out.string());
  for (const std::string& what : result.outcome.departs) say("two runs of one case differ: " + what);
  for (const std::string& what : result.outcome.failed) say("not timed, it has no solution: " + what);
  if (stop) {
    say("interrupted; finished runs are stored, and the same command goes on from them");
    return interrupted;
  }
  return !result.outcome.departs.empty() ? departs : !result.outcome.failed.empty() ? numerical_failure : done;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Verification and convergence studies of asymptotically compatible particle schemes for linear advection.");
  app.set_version_flag("--version", fmt::format("acstudy {}", build_info::version));
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done and all as expected, 1 a verdict departs, 2 bad input (nothing run or written),\n"
      "3 a run failed numerically, 4 the machine failed it, 130 interrupted.");

  std::vector<std::string> files;
  RunOptions options;
  options.jobs = available_processors();
  std::string out = options.out.string(), what, form = "vector";
  std::optional<std::string> junit;
  bool github = false;

  CLI::App* const run_command = app.add_subcommand("run", "Run every case of the studies that is not stored yet");
  run_command->add_option("STUDY.toml", files, "study files")->required();
  run_command->add_option("--out", out, "folder for DIR/<study>.h5 and .json")->type_name("DIR")->capture_default_str();
  run_command->add_option("--jobs", options.jobs, "cases run at the same time; numbers do not depend on it")
      ->type_name("N")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  run_command->add_option("--repeats", options.repeats, "run each case at least N times, for its run time and spread")
      ->type_name("N")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  run_command->add_flag("--fresh", options.fresh, "run stored cases again");
  run_command
      ->add_option("--form", form, "vector: several particles at a time, weights never stored; readable: its reference")
      ->type_name("NAME")
      ->check(CLI::IsMember({"vector", "readable"}))
      ->capture_default_str();

  CLI::App* const check_command =
      app.add_subcommand("check", "The gate: judge result files; exit 1 if a verdict departs");
  check_command->add_option("FILE.json", files, "result files")->required();
  check_command->add_option("--junit", junit, "write the gates as JUnit XML, too")->type_name("FILE");
  check_command->add_flag("--github", github, "print an annotation for GitHub Actions per gate that departs");

  FitRequest request;
  bool json = false;
  CLI::App* const fit_command = app.add_subcommand(
      "fit",
      "Judge a table of errors or values; exit 0 only if all have the order of --order, or without it a sharp one");
  fit_command->add_option("TABLE.csv", request.file, "a table whose first line names its columns; -: standard input")
      ->required();
  CLI::Option* const variable_option = fit_command->add_option("--variable", request.variable, "column of the variable")
                                           ->type_name("NAME")
                                           ->capture_default_str();
  CLI::Option* const count_option =
      fit_command->add_option("--count", request.count, "in its place, column of a number n of cells: h = n^(-1/D)")
          ->type_name("NAME")
          ->excludes(variable_option);
  fit_command->add_option("--dimension", request.dimension, "dimension D of the space that the cells fill")
      ->type_name("D")
      ->needs(count_option)
      ->capture_default_str();
  CLI::Option* const error_option =
      fit_command
          ->add_option("--error", request.errors,
                       "columns of errors, each judged; all: every column of numbers but variable, count and weight")
          ->type_name("NAME,...")
          ->allow_extra_args(false)
          ->capture_default_str();
  CLI::Option* const weight_option =
      fit_command
          ->add_option("--weight", request.weight, "column of weights, as one over the variance of the relative error")
          ->type_name("NAME");
  CLI::Option* const value_option =
      fit_command
          ->add_option("--value", request.values,
                       "without an exact solution: columns of values, as norms or functionals of the solution")
          ->type_name("NAME,...")
          ->allow_extra_args(false)
          ->excludes(error_option)
          ->excludes(weight_option);
  fit_command
      ->add_option("--difference", request.differences,
                   "columns of differences of successive levels, or their norms; empty for the finest level")
      ->type_name("NAME,...")
      ->allow_extra_args(false)
      ->excludes(error_option)
      ->excludes(weight_option)
      ->excludes(value_option);
  fit_command
      ->add_option("--levels", request.levels, "levels to judge, as 3:8, 3: or :6; 1 is the coarsest, ends included")
      ->type_name("A:B");
  fit_command->add_option("--order", request.order, "theory's order; 0: the error must settle")->type_name("P");
  fit_command
      ->add_option("--scale", request.options.scale, "size of the solution; errors below 1e-12 times it are round-off")
      ->type_name("S");
  fit_command
      ->add_option("--floor", request.options.floor,
                   "error that round-off, quadrature or iteration leaves; errors below it tell nothing")
      ->type_name("F");
  fit_command->add_flag("--json", json, "print one JSON object");

  BenchRequest bench_request;
  std::string bench_out = bench_request.out.string();
  CLI::App* const bench_command = app.add_subcommand(
      "bench",
      "Time the cases of convergence studies, each alone, in turn with all others; exit 1 if two runs of one "
      "case differ in error or work");
  bench_command->add_option("STUDY.toml", files, "study files")->required();
  bench_command->add_option("--out", bench_out, "folder for DIR/bench.h5 and DIR/bench.json")
      ->type_name("DIR")
      ->capture_default_str();
  bench_command->add_option("--runs", bench_request.options.runs, "least number of timed runs of a case")
      ->type_name("N")
      ->check(CLI::Range(std::int64_t{1}, most_runs))
      ->capture_default_str();
  bench_command
      ->add_option("--least-seconds", bench_request.options.least_seconds,
                   fmt::format("least time of the timed runs of a case in all; {} runs do", most_runs))
      ->type_name("S")
      ->check(real_range(0.0, 3600.0))
      ->capture_default_str();
  bench_command
      ->add_option("--threads", bench_request.options.threads,
                   "threads that share the work of a case; several numbers, as in 1,2, time each case with each")
      ->type_name("N,...")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  bench_command->add_flag("--fresh", bench_request.fresh, "drop the samples of an earlier bench in DIR");

  CLI::App* const explain_command =
      app.add_subcommand("explain", "Print what a study computes and what it leaves out; computes nothing");
  explain_command->add_option("STUDY.toml", files, "study files")->required();

  CLI::App* const list_command = app.add_subcommand("list", "Print what can be named in a study");
  list_command->add_option("WHAT", what, "schemes, kernels, integrators or scenes; everything by default")
      ->check(CLI::IsMember({"schemes", "kernels", "integrators", "scenes"}));

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    const auto used = app.get_subcommands();
    if (used.empty() && argc > 1) {
      say(fmt::format("unknown command {}; write run, check, fit, bench, explain or list; see acstudy --help",
                      in_quotes(argv[1])));
      return bad_input;
    }
    say(fmt::format("{}; see acstudy {}--help", error.what(), used.empty() ? "" : used.front()->get_name() + " "));
    return bad_input;
  }

  try {
    int status = done;
    std::string command;
    for (int i = 0; i < argc; ++i) command += (i > 0 ? " " : "") + std::string(argv[i]);
    if (*run_command) {
      options.out = out;
      options.command = command;
      options.readable = form == "readable";
      status = run(files, options);
    } else if (*check_command) {
      status = check(files, junit, github);
    } else if (*bench_command) {
      bench_request.out = bench_out;
      bench_request.command = command;
      status = bench(files, bench_request);
    } else if (*fit_command) {
      const auto print = [&](const auto& fits) {
        fmt::print("{}", json ? as_json(fits) : as_text(fits));
        status = fits.passes() ? done : departs;
      };
      if (request.values.empty() && request.differences.empty()) {
        print(fit_table(request));
      } else {
        print(fit_values(request));
      }
    } else if (*list_command) {
      print_list(what);
    } else {
      for (const Study& study : read_studies(files)) fmt::print("{}", explain(study));
    }
    if (std::fflush(stdout) != 0)
      throw StoreError("cannot write to standard output: " + std::string(std::strerror(errno)));
    return status;
  } catch (const InputError& error) {
    say(error.what());
    return bad_input;
  } catch (const std::exception& error) {
    say(error.what());
    return machine_failure;
  }
}
