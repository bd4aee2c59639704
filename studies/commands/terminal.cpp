#include "studies/commands/terminal.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace acstudy {

namespace {

int descriptor(Stream stream) { return stream == Stream::out ? STDOUT_FILENO : STDERR_FILENO; }

winsize size_of(Stream stream) {
  winsize size{};
  if (ioctl(descriptor(stream), TIOCGWINSZ, &size) != 0) return {};
  return size;
}

bool is_set(const char* variable) {
  const char* const value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

bool starts_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }

}  // namespace

bool on_terminal(Stream stream) { return isatty(descriptor(stream)) != 0; }

std::size_t columns(Stream stream) {
  constexpr std::size_t least = 20, most = 100'000, usual = 80;
  const std::size_t said = is_set("COLUMNS") ? std::strtoul(std::getenv("COLUMNS"), nullptr, 10) : 0;
  const std::size_t now = said > 0 ? said : size_of(stream).ws_col;
  return now > 0 ? std::clamp(now, least, most) : usual;
}

std::size_t table_width() {
  return on_terminal(Stream::out) ? columns(Stream::out) : std::numeric_limits<std::size_t>::max();
}

std::size_t screen_lines(Stream stream) {
  const std::size_t lines = size_of(stream).ws_row;
  return lines > 0 ? lines : 24;
}

std::string colored(const std::string& text, Color color) {
  static const bool colors = on_terminal(Stream::out) && !is_set("NO_COLOR") &&
                             std::string(is_set("TERM") ? std::getenv("TERM") : "dumb") != "dumb";
  if (!colors) return text;
  const char* const code = color == Color::red ? "1;31" : color == Color::green ? "32" : "2";
  return fmt::format("\033[{}m{}\033[0m", code, text);
}

std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), starts_character));
}

std::string cut(std::string_view text, std::size_t width) {
  std::size_t end = 0;
  for (std::size_t count = 0; end < text.size(); ++end) {
    if (starts_character(text[end]) && ++count > width) break;
  }
  return std::string(text.substr(0, end));
}

std::string wrapped(std::string_view text, std::size_t width, std::size_t indent) {
  const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
  std::string out(text.substr(0, begin));
  std::size_t used = begin;
  bool line_is_empty = true;
  for (std::size_t at = begin; at < text.size();) {
    const std::size_t blanks = std::min(text.find_first_not_of(' ', at), text.size()) - at;
    const std::size_t end = std::min(text.find(' ', at + blanks), text.size());
    const std::string_view word = text.substr(at + blanks, end - at - blanks);
    if (word.empty()) break;
    if (!line_is_empty && used + blanks + width_of(word) > width) {
      out += "\n" + std::string(indent, ' ');
      used = indent;
    } else {
      out += std::string(blanks, ' ');
      used += blanks;
    }
    out += word;
    used += width_of(word);
    line_is_empty = false;
    at = end;
  }
  return out;
}

std::string fitted(std::string_view text) {
  if (!on_terminal(Stream::out)) return std::string(text);
  const std::size_t width = columns(Stream::out);
  std::string out;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    // The last column has to leave room for words.
    const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
    const std::size_t gap = line.substr(0, std::min(line.size(), width / 2)).rfind("  ");
    const std::size_t indent = gap == std::string_view::npos || gap + 2 <= begin ? begin + 4 : gap + 2;
    out += wrapped(line, width, indent);
    if (end < text.size()) out += '\n';
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

}  // namespace acstudy
