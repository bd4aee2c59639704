#pragma once

/// @file
/// Interruptions: what is running ends at its next step, and what is done is kept.

#include <atomic>
#include <functional>

namespace acstudy {

/// True from the moment at which the user interrupts or ends the program (SIGINT, SIGTERM, and SIGHUP unless it is
/// ignored, as under nohup), which from this call on does nothing else.
const std::atomic<bool>& stop_on_signals();

/// Does the work in a thread of its own and waits for it; once `stop` is true half a second at most. False if it goes
/// on after that: nothing that it uses may be changed or end before the program does, by `leave`.
bool done_before_stop(const std::atomic<bool>& stop, std::function<void()> work);

/// Ends the program at once, whatever its other threads do.
[[noreturn]] void leave(int status);

}  // namespace acstudy
