#include "studies/commands/say.hpp"

#include <cstdio>

#include "studies/commands/terminal.hpp"

namespace acstudy {

void say(const std::string& message) {
  const std::string line = "acstudy: " + message;
  const bool seen = on_terminal(Stream::error);
  std::fputs(((seen ? wrapped(line, columns(Stream::error), 4) : line) + "\n").c_str(), stderr);
}

void say_damaged(const std::string& file) {
  say("note: " + file + ": its checksum is not that of its values: it was damaged or edited; run the study again");
}

}  // namespace acstudy
