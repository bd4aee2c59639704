#pragma once

/// @file
/// `acstudy bench`: plans, times and stores.

#include <filesystem>
#include <string>
#include <vector>

#include "studies/commands/bench/bench.hpp"

namespace acstudy {

struct BenchRequest {
  std::filesystem::path out = "reports/out/bench";
  BenchOptions options;
  bool fresh = false;  ///< drop the samples of an earlier bench
  std::string command;
};

struct BenchResult {
  BenchOutcome outcome;
  std::size_t cases = 0;  ///< distinct
  double seconds = 0.0;   ///< that all of it took
  bool complete = false;  ///< every case that has a solution has its number of runs and its time
};

/// Times the cases of convergence studies one at a time and keeps the samples in `request.out`: at the end, when `stop`
/// becomes true, and about once a second, so that nothing that kills the program costs more.
/// @throws InputError, StoreError
BenchResult bench_studies(const std::vector<Study>& studies, const BenchRequest& request,
                          const std::atomic<bool>& stop);

}  // namespace acstudy
