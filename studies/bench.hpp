#pragma once

/// @file
/// Run times of cases, measured so that they can be compared: each case alone, repeatedly, in turn with all others.

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "studies/run_case.hpp"
#include "studies/study.hpp"

namespace acstudy {

/// One timed run of a case.
struct Sample {
  std::int64_t round = 0;    ///< counted from 1; in a round every case that needs another run has one
  std::int64_t session = 0;  ///< counted from 1; a bench that was interrupted has several
  double seconds = 0.0;      ///< of the whole time loop, and the parts of it that are timed apart
  double positions_seconds = 0.0, weights_seconds = 0.0, pairs_seconds = 0.0, source_seconds = 0.0;
};

/// Median, minimum and median absolute deviation from the median.
struct Spread {
  double median, minimum, deviation;
};
/// @pre values are not empty
Spread spread_of(std::vector<double> values);

/// A case with a number of threads, what came out, and its samples.
struct BenchCase {
  const Case* c = nullptr;
  int threads = 1;
  CaseResult result;  ///< of the first run, without fields; its times are not those of the samples
  std::vector<Sample> samples;

  /// One that has no solution is not timed.
  bool timed() const { return result.failure.empty() && result.blow_up.empty(); }
  double total_seconds() const;
};

/// A series of a study: its cases as indices of the bench's.
struct BenchSeries {
  const Study* study;
  const Series* series;
  int threads;
  std::vector<std::size_t> cases;
};

struct Bench {
  std::vector<BenchCase> cases;  ///< distinct
  std::vector<BenchSeries> series;
};

struct BenchOptions {
  std::int64_t runs = 5;       ///< least number of timed runs of a case
  double least_seconds = 0.2;  ///< least time of these in all; `most_runs` do, however short they are
  std::vector<int> threads = {1};
};

inline constexpr std::int64_t most_runs = 10000;

/// Under which samples may be kept: the case, the code that computes it, the number of threads.
std::string bench_key(const BenchCase& one);

/// The distinct cases of convergence studies, each with every number of threads, in the order of the studies.
/// @throws InputError for a study of another kind
Bench plan_bench(std::span<const Study> studies, const std::vector<int>& threads);

/// How a bench runs a case, and whom it tells.
struct BenchHooks {
  std::function<CaseResult(const Case&, int threads)> run;
  std::function<void(std::int64_t round, std::size_t open)> after_round;  ///< `open`: cases that need more runs
};

/// What came of a bench.
struct BenchOutcome {
  std::int64_t runs = 0;             ///< timed ones
  std::vector<std::string> departs;  ///< cases whose error or work was not that of their first run
  std::vector<std::string> failed;   ///< cases that have no solution
};

/// Times the cases until each has its number of runs and its time.
///
/// Every case that needs a run first has one that is not timed. Then there are rounds; in a round every case that needs
/// another run has one, in order, so that a disturbance of the machine meets all cases alike. A case that has samples
/// already, from a bench that was interrupted, goes on from them. Errors and work of every run have to be those of the
/// first, to the last bit.
/// @param stop  once true the bench ends; runs that were finished keep their samples
BenchOutcome time_cases(Bench& bench, const BenchOptions& options, const BenchHooks& hooks,
                        const std::atomic<bool>& stop);

}  // namespace acstudy
