#pragma once

/// @file
/// Messages to the user.

#include <string>

namespace acstudy {

/// A line on stderr, on a terminal wrapped; whether anybody can read it must not matter to the exit code.
void say(const std::string& message);

/// Of a file whose checksum is not that of its values.
void say_damaged(const std::string& file);

}  // namespace acstudy
