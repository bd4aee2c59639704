#pragma once

/// @file
/// A case that an outside program runs.

#include <atomic>

#include "studies/cases/case.hpp"
#include "studies/cases/case_result.hpp"

namespace acstudy {

/// Tells the program the case, waits for it, and takes its solution, or its errors.
/// Whatever the program does wrong is the `failure` of the case; a solution that is not finite is a `blow_up`.
/// @pre c.scheme.program
CaseResult run_program(const Case& c, const std::atomic<bool>& stop);

}  // namespace acstudy
