#pragma once

/// @file
/// What a run prints at its end.

#include <string>

#include "studies/commands/run/runner.hpp"

namespace acstudy {

/// Prints what departs, notes and counts, unless the options are quiet; returns the exit code of the verdicts.
/// @param seconds  from the start of the run to its end
/// @param verbose  a table of every series, too
int tell(const RunResult& result, double seconds, const RunOptions& options, bool verbose);

/// The exit code at the end of a command that ran studies; says so and how to go on if it was interrupted, and does not
/// come back if work is still running then.
/// @param status  of a run that was not interrupted
int ended(const RunResult& result, int status, const std::string& how_to_go_on);

}  // namespace acstudy
