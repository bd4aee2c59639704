#include "studies/commands/compare/folded.hpp"

#include <algorithm>

namespace acstudy {

namespace {

/// Columns of a text in UTF-8.
std::size_t columns(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace

Block folded(std::string_view text, const std::string& first, const std::string& next) {
  constexpr std::size_t width = 80;
  Block lines;
  std::string line = first;
  bool empty = true;
  for (std::size_t begin = 0; begin < text.size();) {
    // Blanks go with the word before them, so that columns stay aligned within a line.
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    if (!empty && columns(line) + columns(word) > width) {
      lines.push_back(line);
      line = next;
      empty = true;
    }
    const std::size_t after = std::min(text.find_first_not_of(' ', end), text.size());
    line += word;
    if (after < text.size()) line += std::string(after - end, ' ');
    empty = false;
    begin = after;
  }
  lines.push_back(line);
  for (std::string& one : lines) {
    one.erase(one.find_last_not_of(' ') + 1);
    // What a file says must not steer the terminal.
    std::replace_if(
        one.begin(), one.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }, '?');
  }
  return lines;
}

}  // namespace acstudy
