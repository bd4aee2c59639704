#pragma once

/// @file
/// Lines that a terminal does not break.

#include <string>
#include <string_view>
#include <vector>

namespace acstudy {

using Block = std::vector<std::string>;  ///< lines

/// A text in lines that the terminal does not break, see `wrapped`; control characters become question marks.
/// @param first  begins the first line
/// @param next   blanks that begin the others
Block folded(std::string_view text, const std::string& first, const std::string& next);

/// The first `most` lines; dots at the end of the last say that there are more.
Block shortened(Block lines, std::size_t most);

inline void append(Block& lines, const Block& more) { lines.insert(lines.end(), more.begin(), more.end()); }

inline void print_to(std::string& text, const Block& lines) {
  for (const std::string& line : lines) text += line + "\n";
}

}  // namespace acstudy
