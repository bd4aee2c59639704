#include "studies/running/program/run_program.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "studies/models/outside_program.hpp"
#include "studies/running/program/answer.hpp"
#include "studies/running/program/process.hpp"

namespace acstudy {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t megabyte = 1 << 20;
constexpr std::size_t most_output = 16 * megabyte;

/// A folder that is gone at the end of its life, with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "acstudy-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw std::system_error(errno, std::generic_category(), "a temporary folder");
    }
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// A text in one line and in quotes, whatever its bytes.
std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// Bytes that a program wrote as text: valid UTF-8, and of control characters line ends and tabs only.
std::string readable(const std::string& bytes) {
  std::string text = nlohmann::json::parse(quoted(bytes)).get<std::string>();
  for (char& c : text) {
    if (is_control(c) && c != '\n' && c != '\t') c = '?';
  }
  return text;
}

/// What is wrong with such an end; empty if nothing is.
std::string fault(const ProcessEnd& end, double timeout) {
  switch (end.how) {
    case ProcessEnd::How::not_started:
      return fmt::format("cannot be started: {}", std::strerror(end.code));
    case ProcessEnd::How::timed_out:
      return fmt::format("was ended after its timeout of {:g} s", timeout);
    case ProcessEnd::How::wrote_too_much:
      return fmt::format(
          "was ended after {} MB on stdout, which is for one JSON object; write particles to a file, and "
          "all else to stderr",
          most_output / megabyte);
    case ProcessEnd::How::signaled:
      return fmt::format("was ended by signal {} ({})", end.code, strsignal(end.code));
    case ProcessEnd::How::exited:
      return end.code == 0 ? "" : fmt::format("ended with exit code {}", end.code);
    case ProcessEnd::How::interrupted:
      break;
  }
  return "";
}

CaseResult failed(const Case& c, const std::string& why, const std::string& messages) {
  constexpr std::size_t most = 400;
  const std::string end = messages.substr(messages.size() - std::min(most, messages.size()));
  CaseResult result;
  result.error_linf = result.error_l1 = result.error_l2 = std::numeric_limits<double>::quiet_NaN();
  result.failure = fmt::format("N = {}: {} {}", c.N, c.scheme.program->command_line(), why);
  if (!end.empty()) result.failure += "; its stderr ends with " + quoted(end);
  return result;
}

}  // namespace

CaseResult run_program(const Case& c, const std::atomic<bool>& stop) {
  const OutsideProgram& program = *c.scheme.program;
  std::optional<TemporaryFolder> files;
  if (c.N > most_in_json) files.emplace();
  const TemporaryFile input = file_of(case_json(c, files ? files->path() : fs::path()));
  const ProcessEnd end =
      run_process(program.command, program.folder, input.get(), {program.timeout, most_output}, stop);
  CaseResult result;
  if (end.how == ProcessEnd::How::interrupted) return result;

  std::string why = fault(end, program.timeout);
  result.seconds = end.seconds;
  if (why.empty()) {
    try {
      take_answer(end.out, c, result);
    } catch (const AnswerError& error) {
      why = error.what();
    }
  }
  const std::string messages = readable(end.messages);
  if (!why.empty()) result = failed(c, why, messages);
  result.messages = messages;
  result.steps = c.steps;
  result.dt = result.dt_smallest = c.dt;
  result.completed = true;
  return result;
}

}  // namespace acstudy
