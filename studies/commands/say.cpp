#include "studies/commands/say.hpp"

#include <cstdio>

#include "studies/commands/terminal.hpp"

namespace acstudy {

void say(const std::string& message) {
  const std::string line = "acstudy: " + message;
  const bool seen = on_terminal(Stream::error);
  std::fputs(((seen ? wrapped(line, columns(Stream::error), 4) : line) + "\n").c_str(), stderr);
}

}  // namespace acstudy
