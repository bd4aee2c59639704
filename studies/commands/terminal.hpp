#pragma once

/// @file
/// The terminal: how wide it is, whether it takes colors, and lines that fit it.

#include <cstddef>
#include <string>
#include <string_view>

namespace acstudy {

/// Where the program writes.
enum class Stream { out, error };

bool on_terminal(Stream stream);
/// Columns of a line: $COLUMNS, or those of the terminal, or 80; 20 at least.
std::size_t columns(Stream stream);
/// Columns of a table on standard output: those of the terminal. Elsewhere its lines are searched, and stay whole.
std::size_t table_width();
/// Lines of the terminal, 24 where it does not say.
std::size_t screen_lines(Stream stream);

enum class Color { red, green, faint };
/// The text in a color if standard output is a terminal that has some and $NO_COLOR is not set; else as it is.
std::string colored(const std::string& text, Color color);

/// Characters of a UTF-8 text.
std::size_t width_of(std::string_view text);
/// The first characters of a text, at most so many.
std::string cut(std::string_view text, std::size_t width);

/// The text in lines of at most `width` characters, broken at blanks; a word that is longer stands alone. Lines but the
/// first begin with `indent` blanks; blanks at the beginning of the text stay. No line break at the end.
std::string wrapped(std::string_view text, std::size_t width, std::size_t indent = 0);

/// A text of several lines as standard output takes it: on a terminal those that are too long are wrapped, and go on
/// where their last column of the text begins, which two blanks or more precede. Elsewhere they stay, to be searched.
std::string fitted(std::string_view text);

}  // namespace acstudy
