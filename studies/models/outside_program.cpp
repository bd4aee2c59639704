#include "studies/models/outside_program.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace acstudy {

std::string OutsideProgram::command_line() const {
  std::string text = fmt::format("{}", fmt::join(command, " "));
  std::replace_if(text.begin(), text.end(), is_control, ' ');
  return text;
}

std::string OutsideProgram::key() const {
  std::string text;
  // With their lengths, so that no two lists of words give the same text.
  for (const std::string& word : command) text += fmt::format("{}:{},", word.size(), word);
  for (const Input& input : inputs)
    text += fmt::format("{}:{}={:016x},", input.file.size(), input.file, input.checksum);
  return text;
}

constinit const ModelCard outside_model = {.number = 0, .name = "outside program"};

}  // namespace acstudy
