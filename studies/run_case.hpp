#pragma once

/// @file
/// One case from start to error.

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "solver/velocity.hpp"
#include "studies/study.hpp"

namespace acstudy {

struct CaseResult {
  bool completed = false;  ///< false: interrupted, nothing else is meaningful
  std::string blow_up;     ///< when the solution ceased to be finite, if it did; the errors are then NaN
  std::string failure;     ///< why there is no solution for another reason, if so; the errors are then NaN
  double error_linf = 0.0;
  double error_l1 = 0.0, error_l2 = 0.0;  ///< weighted by cell width, divided by the period

  double seconds = 0.0;                          ///< wall time of the whole time loop, median over the repeats
  double seconds_low = 0.0, seconds_high = 0.0;  ///< fastest and slowest repeat
  double source_seconds = 0.0;                   ///< part of `seconds` spent in the manufactured source
  std::int64_t repeats = 0;

  WorkCounts work;
  std::int64_t quadrature_points = 0;
  std::int64_t flow_evaluations = 0;  ///< particle positions computed after the start

  std::vector<double> x, u, u_exact;  ///< fields at T, shape [N]
};

/// Runs a case, several times if it is short, so that its run time means something.
///
/// @param least_repeats  runs of a case however long it is
/// @param timed  false where only the solution counts: one run, unless `least_repeats` asks for more
/// @param stop  looked at between time steps; once true the run ends with `completed` false
CaseResult run_case(const Case& c, const std::atomic<bool>& stop, std::size_t least_repeats = 1, bool timed = true);

}  // namespace acstudy
