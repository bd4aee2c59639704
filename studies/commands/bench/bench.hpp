#pragma once

/// @file
/// Run times of cases, measured so that they can be compared: each case alone, repeatedly, in turn with all others.

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "studies/cases/bench.hpp"

namespace acstudy {

inline constexpr std::int64_t most_runs = 10000;

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
