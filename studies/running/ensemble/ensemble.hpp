#pragma once

/// @file
/// Cases on the same particles of a line, advanced together in the vector form of their schemes.

#include <atomic>
#include <limits>
#include <span>
#include <vector>

#include "studies/cases/case_result.hpp"
#include "studies/running/plan.hpp"

namespace acstudy {

/// Runs cases that are planned together from start to error, once.
///
/// Positions, velocities and the source of the PDE are computed once for all; local and nonlocal divergence of one
/// model at one horizon share their sweep over pairs. `seconds` of a case are its share: those of all cases add up to
/// the time that passed.
/// @param threads  that share the work; the numbers do not depend on it
/// @param stop     looked at between time steps; once true, results of cases that are still running have `completed`
///                 false
/// @param most_seconds  once it can be seen that all would take much longer, some cases are put off: they are left
///                      where they are, with `completed` false, so that the others are done in about that time
/// @pre   equal `particles` of all plans, in forms that run cases together
std::vector<CaseResult> run_ensemble(std::span<const Plan> plans, int threads, const std::atomic<bool>& stop,
                                     double most_seconds = std::numeric_limits<double>::infinity());

}  // namespace acstudy
