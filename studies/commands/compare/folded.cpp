#include "studies/commands/compare/folded.hpp"

#include <algorithm>

#include "studies/commands/terminal.hpp"

namespace acstudy {

Block folded(std::string_view text, const std::string& first, const std::string& next) {
  std::string safe(text);
  // What a file says must not steer the terminal.
  std::replace_if(
      safe.begin(), safe.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }, '?');
  const std::string all = wrapped(first + safe, columns(Stream::out), next.size());
  Block lines;
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
    end = all.find('\n', begin);
    lines.push_back(all.substr(begin, end - begin));
  }
  return lines;
}

Block shortened(Block lines, std::size_t most) {
  if (lines.size() <= most) return lines;
  lines.resize(most);
  std::string& last = lines.back();
  while (width_of(last) + 4 > columns(Stream::out)) last.erase(last.find_last_of(' '));
  last += " ...";
  return lines;
}

}  // namespace acstudy
