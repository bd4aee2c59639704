/// @file
/// The command line: acstudy run | check | fit | explain | list.

#include <fmt/format.h>
#include <sched.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <set>
#include <thread>

#include "build_info.hpp"
#include "studies/check.hpp"
#include "studies/explain.hpp"
#include "studies/fit.hpp"
#include "studies/runner.hpp"
#include "studies/study_file.hpp"

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

/// Makes the output folder and tries it, before hours of work depend on it.
void prepare_folder(const fs::path& out) {
  std::error_code error;
  fs::create_directories(out, error);
  const fs::path probe = out / ".acstudy-writable";
  std::FILE* const file = error ? nullptr : std::fopen(probe.c_str(), "w");
  if (file == nullptr) {
    throw InputError(fmt::format("{}: cannot write to the output folder: {}; name another one with --out", out.string(),
                                 error ? error.message() : std::strerror(errno)));
  }
  std::fclose(file);
  fs::remove(probe, error);
}

std::string interval(const Judgement& judgement) {
  if (std::isnan(judgement.order)) return "-";
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", judgement.order, judgement.low, judgement.high);
}

/// A line of the table that `run` and `check` print.
struct Row {
  bool passes;
  std::string study, series;
  Judgement judgement;
  Verdict expected;
  std::string remark;
};

void print_table(const std::vector<Row>& rows) {
  std::size_t study_width = 0, series_width = 0;
  for (const Row& row : rows) {
    study_width = std::max(study_width, row.study.size());
    series_width = std::max(series_width, row.series.size());
  }
  for (const Row& row : rows) {
    fmt::print("{:<6}  {:<{}}  {:<{}}  {:<20}  {}", row.passes ? "ok" : "DEPART", row.study, study_width, row.series,
               series_width, interval(row.judgement), name_of(row.judgement.verdict));
    if (!row.passes) fmt::print(", expected {}: {}", name_of(row.expected), row.remark);
    fmt::print("\n");
  }
}

int run(const std::vector<std::string>& files, RunOptions options) {
  const std::vector<Study> studies = read_studies(files);
  prepare_folder(options.out);
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);

  const RunResult result = run_studies(studies, options, stop);
  int status = done;
  std::vector<Row> rows;
  for (const StudyResult& study : result.studies) {
    for (const auto& finding : study.findings) {
      if (!finding) continue;
      rows.push_back({finding->as_expected(), study.study->name, finding->label(), finding->judgement,
                      finding->expected, finding->judgement.reason});
      if (!finding->as_expected()) status = std::max<int>(status, departs);
    }
    if (!study.study->judged_by_series()) continue;
    for (const SeriesResult& series : study.series) {
      if (result.interrupted && series.completed().size() < series.results.size()) continue;
      const bool passes = series.as_expected();
      rows.push_back({passes, study.study->name, series.series->label(), series.judgement, series.series->expected,
                      series.judgement.reason});
      if (!passes) {
        const bool numerical = series.failed() || series.judgement.verdict == Verdict::unstable;
        status = std::max<int>(status, numerical ? numerical_failure : departs);
      }
    }
  }
  print_table(rows);
  fmt::print("{} cases computed, {} taken from the store; results in {}\n", result.computed, result.reused,
             options.out.string());
  if (result.interrupted) {
    say("interrupted; finished cases are stored, and the same command goes on from them");
    return interrupted;
  }
  return status;
}

int check(const std::vector<std::string>& files) {
  std::vector<Row> rows;
  std::size_t departing = 0;
  for (const std::string& file : files) {
    const ResultRecord record = read_json(file);
    for (const FindingRecord& found : record.findings) {
      const Finding& finding = found.finding;
      const bool passes = finding.as_expected() && found.verdict == name_of(finding.judgement.verdict);
      rows.push_back({passes, found.study, finding.label(), finding.judgement, finding.expected,
                      found.verdict == name_of(finding.judgement.verdict)
                          ? finding.judgement.reason
                          : fmt::format("the file says {}, but its values say otherwise: {}", found.verdict,
                                        finding.judgement.reason)});
      departing += passes ? 0 : 1;
    }
    for (const CheckedSeries& series : check_series(record.series)) {
      rows.push_back({series.passes(), series.record.study, series.record.label, series.judgement,
                      series.record.expected, series.remark()});
      departing += series.passes() ? 0 : 1;
    }
  }
  print_table(rows);
  fmt::print("{} series, {} as expected, {} departing\n", rows.size(), rows.size() - departing, departing);
  return departing == 0 ? done : departs;
}

int list(const std::string& what) {
  const auto heading = [&](const char* title) {
    if (what.empty()) fmt::print("{}:\n", title);
  };
  const char* indent = what.empty() ? "  " : "";
  if (what.empty() || what == "schemes") {
    heading("schemes");
    fmt::print(
        "{0}model = 1, divergence = \"local\"     Model I, scheme 1 (2.9); (2.4) where particles stand still\n"
        "{0}model = 1, divergence = \"nonlocal\"  Model I, scheme 2 (2.11)\n"
        "{0}model = 2, divergence = \"local\"     Model II, scheme 1 (3.8); (3.6) where particles stand still\n"
        "{0}model = 2, divergence = \"nonlocal\"  Model II, scheme 2 (3.10)\n",
        indent);
  }
  if (what.empty() || what == "kernels") {
    heading("kernels");
    for (const NamedKernel& kernel : named_kernels) fmt::print("{}{:<35} {}\n", indent, kernel.written, kernel.meaning);
  }
  if (what.empty() || what == "integrators") {
    heading("integrators");
    for (const Integrator& integrator : integrators) {
      fmt::print("{}{:<35} order {}, {} stage(s)\n", indent, fmt::format("\"{}\"", integrator.name), integrator.order,
                 integrator.stages.size());
    }
  }
  if (what.empty() || what == "scenes") {
    heading("scenes");
    for (const SceneText& scene : named_scenes()) {
      fmt::print("{}{:<35} period {}, T = {}, c = {}, b = {}, u = {}\n", indent, fmt::format("\"{}\"", scene.name),
                 scene.period, scene.T, scene.c, scene.b.value_or("0"), scene.u);
    }
  }
  return done;
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
  std::string out = options.out.string(), what;

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

  CLI::App* const check_command =
      app.add_subcommand("check", "The gate: judge result files; exit 1 if a verdict departs");
  check_command->add_option("FILE.json", files, "result files")->required();

  FitRequest request;
  bool json = false;
  CLI::App* const fit_command =
      app.add_subcommand("fit", "Judge a table of errors; exit 0 only if they have the order of --order");
  fit_command->add_option("TABLE.csv", request.file, "a table whose first line names its columns")->required();
  fit_command->add_option("--variable", request.variable, "column of the variable")
      ->type_name("NAME")
      ->capture_default_str();
  fit_command->add_option("--error", request.error, "column of the errors")->type_name("NAME")->capture_default_str();
  fit_command
      ->add_option("--weight", request.weight, "column of weights, as one over the variance of the relative error")
      ->type_name("NAME");
  fit_command->add_option("--order", request.order, "theory's order; 0: the error must settle")->type_name("P");
  fit_command->add_flag("--json", json, "print one JSON object");

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
      say(fmt::format("unknown command \"{}\"; write run, check, fit, explain or list; see acstudy --help", argv[1]));
      return bad_input;
    }
    say(fmt::format("{}; see acstudy {}--help", error.what(), used.empty() ? "" : used.front()->get_name() + " "));
    return bad_input;
  }

  try {
    int status = done;
    if (*run_command) {
      options.out = out;
      for (int i = 0; i < argc; ++i) options.command += (i > 0 ? " " : "") + std::string(argv[i]);
      status = run(files, options);
    } else if (*check_command) {
      status = check(files);
    } else if (*fit_command) {
      const Fit fit = fit_table(request);
      fmt::print("{}", json ? as_json(fit) : as_text(fit));
      status = fit.passes() ? done : departs;
    } else if (*list_command) {
      status = list(what);
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
