#pragma once

/// @file
/// Interruptions: what is running ends at its next step, and what is done is kept.

#include <atomic>

namespace acstudy {

/// True from the moment at which the user interrupts or ends the program (SIGINT, SIGTERM), which from this call on
/// does nothing else.
const std::atomic<bool>& stop_on_signals();

}  // namespace acstudy
