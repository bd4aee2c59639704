#pragma once

/// @file
/// One case from start to error.

#include <atomic>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "studies/cases/case_result.hpp"
#include "studies/running/plan.hpp"

namespace acstudy {

/// Runs a case `repeats` times and takes the median of its times.
///
/// @param stop     looked at between time steps; once true the run ends with `completed` false
/// @param threads  that share the work, where the form of the case can; the numbers do not depend on it
CaseResult run_case(const Case& c, const std::atomic<bool>& stop, std::size_t repeats = 1, int threads = 1);

/// The same for one planned case, or several with equal `particles`, together.
/// @param most_seconds  where all together would take much longer, some are put off: their `completed` is false
std::vector<CaseResult> run_cases(std::span<const Plan> plans, const std::atomic<bool>& stop, std::size_t repeats = 1,
                                  int threads = 1, double most_seconds = std::numeric_limits<double>::infinity());

}  // namespace acstudy
