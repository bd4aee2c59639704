#pragma once

/// @file
/// Messages to the user.

#include <cstdio>
#include <string>

namespace acstudy {

/// A line on stderr; whether anybody can read it must not matter to the exit code.
inline void say(const std::string& message) { std::fputs(("acstudy: " + message + "\n").c_str(), stderr); }

}  // namespace acstudy
