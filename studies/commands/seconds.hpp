#pragma once

/// @file
/// Seconds as a reader wants them.

#include <fmt/format.h>

#include <string>

namespace acstudy {

/// With two significant digits, as a run time has them: "0.031 s", "2.4 s"; whole seconds from 10 on: "134 s".
inline std::string seconds_text(double seconds) {
  if (seconds < 0.001) return "< 0.001 s";
  return seconds < 9.95 ? fmt::format("{:#.2g} s", seconds) : fmt::format("{:.0f} s", seconds);
}

}  // namespace acstudy
