#pragma once

/// @file
/// Lines that a terminal does not break.

#include <string>
#include <string_view>
#include <vector>

namespace acstudy {

/// A text in lines of 80 columns at most, broken between words; a longer word has a line of its own.
/// @param first  begins the first line
/// @param next   begins the others
std::vector<std::string> folded(std::string_view text, const std::string& first, const std::string& next);

inline void append(std::vector<std::string>& lines, const std::vector<std::string>& more) {
  lines.insert(lines.end(), more.begin(), more.end());
}

}  // namespace acstudy
