#pragma once

/// @file
/// What the exit code of the program says.

namespace acstudy {

enum Exit : int { done = 0, departs = 1, bad_input = 2, numerical_failure = 3, machine_failure = 4, interrupted = 130 };

}  // namespace acstudy
