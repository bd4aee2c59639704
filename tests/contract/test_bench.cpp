#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "studies/commands/bench/bench.hpp"
#include "studies/kinds/study_file.hpp"
#include "studies/reading/input_error.hpp"
#include "studies/storing/bench_store.hpp"
#include "tests/catch.hpp"

namespace acstudy {
namespace {

namespace fs = std::filesystem;

const std::string two_models =
    "[study]\nname = \"two\"\n[scene]\nuse = \"lee-du-2019\"\n"
    "[[scheme]]\nmodel = 1\ndivergence = \"local\"\nkernel = \"inverse\"\n"
    "[[scheme]]\nmodel = 2\ndivergence = \"nonlocal\"\nkernel = \"cubic-spline\"\n"
    "[time]\nintegrator = \"forward-euler\"\nstep = \"h/4\"\n"
    "[[path]]\nname = \"wide\"\ndelta = 0.4\nN = [20, 40]\nsource = \"local\"\n"
    "[[path]]\nname = \"narrow\"\ndelta = \"4*h\"\nN = [20, 40, 80]\nsource = \"local\"\n";

std::vector<Study> studies(const std::string& text = two_models) { return {parse_study(text, "two.toml")}; }

/// A machine on which a run takes N / 100 seconds; `calls` are the N in the order of the runs.
struct FakeMachine {
  std::vector<std::int64_t> calls;
  BenchHooks hooks() {
    return {.run =
                [this](const Case& c, int) {
                  calls.push_back(c.N);
                  CaseResult result;
                  result.completed = true;
                  result.error_linf = 1.0 / static_cast<double>(c.N);
                  result.work.pairs = c.N * c.N;
                  result.seconds = 0.01 * static_cast<double>(c.N);
                  result.pairs_seconds = 0.75 * result.seconds;
                  result.x.assign(std::vector{1.0, 2.0});
                  return result;
                },
            .after_round = {}};
  }
};

/// A bench of three cases with N = 20, 40, 80, and their study.
struct SmallBench {
  std::vector<Study> read = studies(two_models.substr(0, two_models.find("[[scheme]]\nmodel = 2")) +
                                    "[time]\nintegrator = \"forward-euler\"\nstep = \"h/4\"\n" +
                                    two_models.substr(two_models.rfind("[[path]]")));
  Bench bench = plan_bench(read, {1});
};

const std::atomic<bool> no_stop{false};

}  // namespace

TEST_CASE("a bench has every distinct case once, with each number of threads", "[bench]") {
  std::vector<Study> twice = studies();
  twice.push_back(parse_study(two_models, "again.toml"));
  const Bench bench = plan_bench(twice, {1, 2});
  CHECK(bench.cases.size() == 2 * 2 * 5);
  CHECK(bench.series.size() == 2 * 2 * 2 * 2);
  std::set<std::string> keys;
  for (const BenchCase& one : bench.cases) keys.insert(bench_key(one));
  CHECK(keys.size() == bench.cases.size());
  for (const BenchSeries& series : bench.series) {
    for (std::size_t i = 0; i < series.cases.size(); ++i) {
      CHECK(bench.cases[series.cases[i]].c->key() == series.series->cases[i].key());
      CHECK(bench.cases[series.cases[i]].threads == series.threads);
    }
  }
  const Study other = parse_study("[study]\nname = \"other\"\nkind = \"corpus\"\n", "other.toml");
  CHECK_THROWS_AS(plan_bench({&other, 1}, {1}), InputError);
}

TEST_CASE("a warm-up of all cases comes first, then rounds in order until each has its runs and its time", "[bench]") {
  SmallBench small;
  FakeMachine machine;
  const BenchOutcome outcome =
      time_cases(small.bench, {.runs = 2, .least_seconds = 0.75, .threads = {1}}, machine.hooks(), no_stop);
  // 0.2, 0.4 and 0.8 s a run: four, two and two runs.
  CHECK(machine.calls == std::vector<std::int64_t>{20, 40, 80, 20, 40, 80, 20, 40, 80, 20, 20});
  CHECK(outcome.runs == 8);
  CHECK(outcome.departs.empty());
  CHECK(outcome.failed.empty());
  const std::vector<Sample>& samples = small.bench.cases[0].samples;
  REQUIRE(samples.size() == 4);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    CHECK(samples[i].round == static_cast<std::int64_t>(i) + 1);
    CHECK(samples[i].session == 1);
    CHECK(samples[i].pairs_seconds == 0.75 * samples[i].seconds);
  }
  CHECK(small.bench.cases[0].result.x.empty());
}

TEST_CASE("runs that take no time end a bench, too", "[bench]") {
  SmallBench small;
  std::int64_t calls = 0;
  const BenchHooks hooks = {.run =
                                [&](const Case&, int) {
                                  ++calls;
                                  CaseResult result;
                                  result.completed = true;
                                  return result;
                                },
                            .after_round = {}};
  time_cases(small.bench, {.runs = 1, .least_seconds = 1.0, .threads = {1}}, hooks, no_stop);
  CHECK(calls == 3 * (most_runs + 1));
}

TEST_CASE("two runs of one case that differ in error or work are noticed", "[bench]") {
  for (const std::string what : {"nothing", "error", "pairs", "steps"}) {
    SmallBench small;
    FakeMachine machine;
    BenchHooks hooks = machine.hooks();
    hooks.run = [&, inner = machine.hooks().run](const Case& c, int threads) {
      CaseResult result = inner(c, threads);
      if (machine.calls.size() == 8) {
        if (what == "error") result.error_linf *= 1.0 + 3e-16;
        if (what == "pairs") ++result.work.pairs;
        if (what == "steps") ++result.steps;
      }
      return result;
    };
    const BenchOutcome outcome =
        time_cases(small.bench, {.runs = 3, .least_seconds = 0.0, .threads = {1}}, hooks, no_stop);
    CAPTURE(what);
    CHECK(outcome.departs.size() == (what == "nothing" ? 0 : 1));
    if (what == "pairs") CHECK(outcome.departs.at(0).find("1600 pairs and then 1601") != std::string::npos);
  }
}

TEST_CASE("a case that has no solution is not timed, and said", "[bench]") {
  SmallBench small;
  FakeMachine machine;
  BenchHooks hooks = machine.hooks();
  hooks.run = [inner = machine.hooks().run](const Case& c, int threads) {
    CaseResult result = inner(c, threads);
    if (c.N == 40) result.blow_up = "is no longer finite";
    return result;
  };
  const BenchOutcome outcome =
      time_cases(small.bench, {.runs = 3, .least_seconds = 0.0, .threads = {1}}, hooks, no_stop);
  CHECK(outcome.failed.size() == 1);
  CHECK(outcome.runs == 6);
  CHECK(small.bench.cases[1].samples.empty());
}

TEST_CASE("a bench that was interrupted keeps its samples and goes on from them", "[bench]") {
  const fs::path folder = fs::temp_directory_path() / ("acstudy-bench-" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const BenchOptions options{.runs = 3, .least_seconds = 0.0, .threads = {1}};
  SmallBench first;
  FakeMachine machine;
  std::atomic<bool> stop{false};
  BenchHooks hooks = machine.hooks();
  hooks.run = [&, inner = machine.hooks().run](const Case& c, int threads) {
    CaseResult result = inner(c, threads);
    // Three runs to warm up and four timed ones; the next one is not finished.
    if (machine.calls.size() == 8) {
      stop = true;
      result.completed = false;
    }
    return result;
  };
  CHECK(time_cases(first.bench, options, hooks, stop).runs == 4);
  write_bench(folder, first.bench, options, collect_provenance(1, "test"), false);

  SmallBench second;
  CHECK(take_up_bench(folder, second.bench) == 3);
  FakeMachine again;
  CHECK(time_cases(second.bench, options, again.hooks(), no_stop).runs == 5);
  std::map<std::int64_t, std::vector<std::int64_t>> sessions;
  for (const BenchCase& one : second.bench.cases) {
    CHECK(one.samples.size() == 3);
    for (const Sample& sample : one.samples) sessions[one.c->N].push_back(sample.session);
  }
  CHECK(sessions[20] == std::vector<std::int64_t>{1, 1, 2});
  CHECK(sessions[80] == std::vector<std::int64_t>{1, 2, 2});
  write_bench(folder, second.bench, options, collect_provenance(1, "test"), true);

  // Finished, it has nothing left to do; another number of threads is another case.
  SmallBench third;
  CHECK(take_up_bench(folder, third.bench) == 3);
  CHECK(time_cases(third.bench, options, again.hooks(), no_stop).runs == 0);
  Bench more_threads = plan_bench(third.read, {2});
  CHECK(take_up_bench(folder, more_threads) == 0);

  // Results that were stored are what later runs are compared with.
  BenchHooks changed = again.hooks();
  changed.run = [inner = again.hooks().run](const Case& c, int threads) {
    CaseResult result = inner(c, threads);
    ++result.work.pairs;
    return result;
  };
  CHECK(time_cases(third.bench, {.runs = 4, .least_seconds = 0.0, .threads = {1}}, changed, no_stop).departs.size() ==
        3);
  fs::remove_all(folder);
}

TEST_CASE("spread is median, minimum and median absolute deviation", "[bench]") {
  const Spread odd = spread_of({5.0, 1.0, 100.0, 2.0, 3.0});
  CHECK(odd.median == 3.0);
  CHECK(odd.minimum == 1.0);
  CHECK(odd.deviation == 2.0);
  const Spread even = spread_of({4.0, 1.0, 2.0, 3.0});
  CHECK(even.median == 2.5);
  CHECK(even.deviation == 1.0);
}

}  // namespace acstudy
