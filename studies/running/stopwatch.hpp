#pragma once

/// @file
/// Wall time of parts of a run.

#include <chrono>

namespace acstudy {

/// Adds to `seconds` how long `work` takes.
template <class Work>
void timed(double& seconds, Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace acstudy
