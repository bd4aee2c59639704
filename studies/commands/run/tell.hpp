#pragma once

/// @file
/// What a run prints at its end.

#include "studies/commands/run/runner.hpp"

namespace acstudy {

/// Prints what departs, notes and counts, unless the options are quiet; returns the exit code of the verdicts.
/// @param seconds  from the start of the run to its end
/// @param verbose  a table of every series, too
int tell(const RunResult& result, double seconds, const RunOptions& options, bool verbose);

}  // namespace acstudy
