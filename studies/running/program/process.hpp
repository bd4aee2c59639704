#pragma once

/// @file
/// A program in a process group of its own, which leaves nothing behind that runs on in this group.

#include <atomic>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace acstudy {

/// A file that is gone once it is closed.
using TemporaryFile = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;
/// One that holds `text`, at its begin.  @throws std::system_error
TemporaryFile file_of(const std::string& text);

struct ProcessLimits {
  double seconds;           ///< from start to end
  std::size_t most_output;  ///< bytes of stdout
};

/// How a program ended, and what it wrote.
struct ProcessEnd {
  enum class How {
    exited,
    signaled,
    not_started,
    timed_out,  ///< its group was killed, here and below
    wrote_too_much,
    interrupted
  };
  How how = How::exited;
  int code = 0;          ///< exit code, signal, or errno
  std::string out;       ///< stdout
  std::string messages;  ///< the last bytes of stderr, at most `kept_messages`
  double seconds = 0.0;  ///< wall time
};
inline constexpr std::size_t kept_messages = 2000;

/// Runs a command and waits for it. Whatever its end, its process group is killed then, so that no child of its keeps
/// running, or a pipe open.
/// @param command  program and arguments, for no shell; the program is looked for on the PATH if it has no '/'
/// @param folder   where it runs; empty: here
/// @param stop     looked at some 20 times a second; once true the program is killed
/// @throws std::system_error if the machine gives no pipe or process state
ProcessEnd run_process(const std::vector<std::string>& command, const std::string& folder, std::FILE* input,
                       const ProcessLimits& limits, const std::atomic<bool>& stop);

}  // namespace acstudy
