// Programs as schemes: how their processes end, and what becomes of their answers.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "studies/kinds/study_file.hpp"
#include "studies/running/program/answer.hpp"
#include "studies/running/program/npy.hpp"
#include "studies/running/program/process.hpp"
#include "tests/catch.hpp"

using Catch::Matchers::WithinAbs;

namespace acstudy {
namespace {

const std::atomic<bool> goes_on{false};
using How = ProcessEnd::How;

ProcessEnd shell(const std::string& script, double seconds = 20.0, std::size_t most_output = 100'000,
                 const std::atomic<bool>& stop = goes_on) {
  const TemporaryFile input = file_of("the case\n");
  return run_process({"sh", "-c", script}, "", input.get(), {seconds, most_output}, stop);
}

/// Waits until no such process is there, or five seconds.
bool is_gone(const std::string& number) {
  const pid_t process = std::stoi(number);
  for (int i = 0; i < 100; ++i) {
    if (kill(process, 0) != 0) return true;
    // Whoever takes up orphans may be slow to bury them.
    std::ifstream status(fmt::format("/proc/{}/stat", process));
    const std::string text{std::istreambuf_iterator<char>(status), {}};
    if (text.find(") Z ") != std::string::npos) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

}  // namespace

TEST_CASE("a program reads its case, and both of its streams are taken to their ends", "[program]") {
  const ProcessEnd end =
      shell("cat; i=0; while [ $i -lt 2000 ]; do echo 0123456789; echo 9876543210 >&2; i=$((i+1)); done");
  CHECK(end.how == How::exited);
  CHECK(end.code == 0);
  CHECK(end.out.size() == 9 + 2000 * 11);
  CHECK(end.out.starts_with("the case\n0123456789\n"));
  CHECK(end.messages.size() == kept_messages);
  CHECK(end.messages.ends_with("9876543210\n"));
}

TEST_CASE("a program ends by its exit code, by a signal, or does not start", "[program]") {
  CHECK(shell("exit 3").code == 3);
  const ProcessEnd killed = shell("kill -TERM $$");
  CHECK(killed.how == How::signaled);
  CHECK(killed.code == SIGTERM);
  const TemporaryFile input = file_of("");
  CHECK(run_process({"no-such-program"}, "", input.get(), {1.0, 10}, goes_on).how == How::not_started);
}

TEST_CASE("a program is ended with its children after its time, its output and an interruption", "[program]") {
  const std::string child = "sleep 600 & echo $!; ";
  const ProcessEnd late = shell(child + "sleep 600", 1.0);
  CHECK(late.how == How::timed_out);
  CHECK(late.seconds < 5.0);
  CHECK(is_gone(late.out));
  const ProcessEnd much = shell("yes", 20.0);
  CHECK(much.how == How::wrote_too_much);
  CHECK(much.out.size() < 300'000);
  const std::atomic<bool> stopped{true};
  CHECK(shell("sleep 600", 20.0, 10, stopped).how == How::interrupted);
  const ProcessEnd orphan = shell(child + "exit 0");
  CHECK(orphan.how == How::exited);
  CHECK(orphan.seconds < 5.0);
  CHECK(is_gone(orphan.out));
}

namespace {

Case some_case() {
  const std::string text = R"toml(
[study]
name = "tiny"

[scene]
period = "2*pi"
T = 1
c = "1"
u = "sin(x - t)"

[[scheme]]
command = ["true"]
order = 1

[[path]]
name = "h alone"
N = [4]
source = "local"
)toml";
  static const Study study = parse_study(text, "tiny.toml");
  return study.series.front().cases.front();
}

std::string fault(const std::string& answer) {
  CaseResult result;
  try {
    take_answer(answer, some_case(), result);
  } catch (const AnswerError& error) {
    return error.what();
  }
  return result.blow_up;
}

}  // namespace

TEST_CASE("particles may come in any order, and from any period", "[program]") {
  constexpr double pi = std::numbers::pi;
  const std::vector<double> x = {0.0, 0.5 * pi, pi, 1.5 * pi};
  const auto answer = [&](const std::vector<std::size_t>& order, double shift) {
    std::vector<double> places, values;
    for (const std::size_t j : order) {
      places.push_back(x[j] + (j % 2 == 0 ? shift : 0.0));
      values.push_back(std::sin(x[j] - 1.0) + 0.01 * static_cast<double>(j));
    }
    CaseResult result;
    take_answer(fmt::format("{{\"x\": [{}], \"u\": [{}]}}", fmt::join(places, ","), fmt::join(values, ",")),
                some_case(), result);
    return result;
  };
  for (const double shift : {0.0, 4.0 * pi, -2.0 * pi}) {
    const CaseResult result = answer({2, 0, 3, 1}, shift);
    CHECK_THAT(result.error_linf, WithinAbs(0.03, 1e-14));
    CHECK_THAT(result.error_l1, WithinAbs(0.015, 1e-14));
    CHECK_THAT(result.error_l2, WithinAbs(0.01 * std::sqrt(14.0 / 4.0), 1e-14));
    CHECK_THAT(result.u[3], WithinAbs(std::sin(x[3] - 1.0) + 0.03, 1e-14));
  }
}

TEST_CASE("what is no answer is named, and what is no number is no error", "[program]") {
  CHECK(fault("").find("nothing") != std::string::npos);
  CHECK(fault("{\"x\": [0,1,2,3], \"u\": [0,0,0").find("not JSON from byte") != std::string::npos);
  CHECK(fault("{\"x\": [0,1,2], \"u\": [0,0,0]}").find("N = 4") != std::string::npos);
  CHECK(fault("{\"x\": [0,1,2,0], \"u\": [0,0,0,0]}").find("two particles at x = 0") != std::string::npos);
  for (const char* const word : {"NaN", "nan", "Infinity", "-Infinity", "-inf", "null"}) {
    CHECK(fault(fmt::format("{{\"x\": [0,1,2,3], \"u\": [0,0,{},0]}}", word)) ==
          "N = 4: the solution is not finite at T, at x = 2");
  }
  CHECK(fault("{\"NaN\": 1}").find("\"NaN\"") != std::string::npos);
}

TEST_CASE("particles in a file of NumPy come back as they are", "[program]") {
  const auto file = std::filesystem::temp_directory_path() / fmt::format("acstudy-test-{}.npy", getpid());
  const auto why_not = [&](std::size_t count) -> std::string {
    try {
      read_npy(file, count);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  const std::vector<double> x = {0.1, 0.2, 0.3}, u = {-1.0, 1e300, 5e-324};
  write_npy(file, x, u);
  const PositionsAndValues back = read_npy(file, 3);
  CHECK(back.x == x);
  CHECK(back.u == u);
  CHECK(why_not(4).find("shape (2, 4)") != std::string::npos);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 1);
  CHECK(why_not(3).find("ends before its array does") != std::string::npos);
  std::filesystem::remove(file);
}

}  // namespace acstudy
