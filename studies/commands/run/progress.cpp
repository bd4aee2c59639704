#include "studies/commands/run/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <system_error>
#include <utility>

#include "studies/commands/seconds.hpp"
#include "studies/commands/terminal.hpp"

namespace acstudy {

namespace {

/// "0 of 4 findings"
std::string count_text(std::size_t done, std::size_t all, const char* what) {
  return fmt::format("{} of {} {}", done, all, what);
}

/// "4 of 40 cases and 0 of 4 findings"
std::string counts_text(const Pace& pace) {
  std::string text;
  if (pace.cases > 0 || pace.findings == 0) text = count_text(pace.cases_done, pace.cases, "cases");
  if (pace.findings == 0) return text;
  return text + (text.empty() ? "" : " and ") + count_text(pace.findings_done, pace.findings, "findings");
}

/// ", about 40 s left"
std::string left_text(std::optional<double> left) {
  return left ? fmt::format(", about {:.0f} s left", std::ceil(*left)) : "";
}

void add_case(Pace& pace, double work, double now) {
  ++pace.cases_done;
  pace.work_done += work;
  if (pace.cases_done == pace.cases) pace.cases_ended = now;
}

void put(const std::string& text) {
  // fputs and not fmt::print, which throws: a terminal that has gone away must not end the run.
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace

std::optional<double> Pace::left(double now) const {
  if (cases_done < cases) return work_done > 0.0 ? std::optional(now * (work - work_done) / work_done) : std::nullopt;
  if (findings_done == findings) return 0.0;
  if (findings_done == 0) return std::nullopt;
  return (now - cases_ended) * static_cast<double>(findings - findings_done) / static_cast<double>(findings_done);
}

std::string Pace::line(double now) const {
  const auto seconds_left = left(now);
  const bool then_findings = cases_done < cases && findings_done < findings;
  return fmt::format("{}, {:.0f} s{}{}", counts_text(*this), std::floor(now), left_text(seconds_left),
                     seconds_left && then_findings ? " for the cases" : "");
}

std::string StudyPace::line(double now, std::size_t width, std::optional<double> most) const {
  const bool cases_open = pace.cases_done < pace.cases;
  const double share = cases_open ? (pace.work > 0.0 ? pace.work_done / pace.work : 0.0)
                       : pace.findings > 0
                           ? static_cast<double>(pace.findings_done) / static_cast<double>(pace.findings)
                           : 1.0;
  auto seconds_left = pace.left(now);
  if (seconds_left && most) seconds_left = std::min(*seconds_left, *most);
  const std::string counts = cases_open || pace.findings == 0
                                 ? count_text(pace.cases_done, pace.cases, "cases")
                                 : count_text(pace.findings_done, pace.findings, "findings");
  return fmt::format("{:<{}}  {:>3.0f} %  {}{}", name, width, std::floor(100.0 * share), counts,
                     left_text(seconds_left));
}

std::string StudyPace::last_line(double seconds, std::size_t width) const {
  std::string counts;
  if (pace.cases > 0) counts = fmt::format("{} cases, ", pace.cases);
  if (pace.findings > 0) counts += fmt::format("{} findings, ", pace.findings);
  return fmt::format("{:<{}}  {}{}", name, width, counts, seconds_text(seconds));
}

Progress::Progress(std::vector<StudyPace> studies, const Pace& all, bool quiet)
    : studies_(std::move(studies)), all_(all), silent_(quiet || !on_terminal(Stream::error)) {
  for (const StudyPace& study : studies_) {
    if (!study.pace.done()) name_width_ = std::max(name_width_, study.name.size());
  }
  if (!all_.done()) show();
}

Progress::~Progress() {
  if (!silent_) put(erased());
}

void Progress::case_added(double work, const std::vector<std::size_t>& studies) {
  const std::lock_guard lock(mutex_);
  const auto add = [&](Pace& pace) {
    ++pace.cases;
    pace.work += work;
  };
  add(all_);
  for (const std::size_t s : studies) add(studies_[s].pace);
}

void Progress::case_done(double work, const std::vector<std::size_t>& studies) {
  const std::lock_guard lock(mutex_);
  add_case(all_, work, now());
  for (const std::size_t s : studies) add_case(studies_[s].pace, work, now());
  write();
}

void Progress::finding_done(std::size_t study) {
  const std::lock_guard lock(mutex_);
  ++all_.findings_done;
  ++studies_[study].pace.findings_done;
  write();
}

void Progress::study_done(std::size_t study, double seconds) {
  const std::lock_guard lock(mutex_);
  if (silent_ || studies_.size() == 1) return;
  put(erased() + cut(studies_[study].last_line(seconds, name_width_), columns(Stream::error) - 1) + "\n");
  written_ = {};
  write();
}

void Progress::show() {
  const std::lock_guard lock(mutex_);
  written_ = {};
  write();
}

std::string Progress::erased() {
  const std::size_t lines = std::exchange(lines_, 0);
  return lines > 1 ? fmt::format("\033[{}A\r\033[J", lines - 1) : "\r\033[K";
}

double Progress::now() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

std::vector<std::string> Progress::lines_at(double seconds) const {
  if (studies_.size() == 1) return {all_.line(seconds)};
  const std::size_t most = std::max<std::size_t>(screen_lines(Stream::error), 4) - 3;
  std::vector<std::string> lines;
  std::size_t hidden = 0;
  for (const StudyPace& study : studies_) {
    if (study.pace.done()) continue;
    if (study.pace.begun() && lines.size() < most) {
      lines.push_back(study.line(seconds, name_width_, all_.left(seconds)));
    } else {
      ++hidden;
    }
  }
  if (hidden > 0) lines.push_back(fmt::format("{} studies wait", hidden));
  lines.push_back(all_.line(seconds));
  return lines;
}

void Progress::write() {
  const auto time = std::chrono::steady_clock::now();
  // Many lines with every case of a millisecond would keep the terminal busy.
  if (silent_ || (lines_ > 1 && time - written_ < std::chrono::milliseconds(100))) return;
  written_ = time;
  const std::vector<std::string> lines = lines_at(now());
  std::string text = erased();
  for (const std::string& line : lines) {
    // A line as wide as the terminal would make another one.
    text += (&line == &lines.front() ? "" : "\n") + cut(line, columns(Stream::error) - 1);
  }
  put(text);
  lines_ = lines.size();
}

EverySecond::EverySecond(std::function<void()> what) {
  try {
    thread_ = std::thread([this, what = std::move(what)] {
      std::unique_lock lock(mutex_);
      for (;;) {
        if (changed_.wait_for(lock, std::chrono::seconds(1), [this] { return ends_; })) return;
        lock.unlock();
        what();
        lock.lock();
      }
    });
  } catch (const std::system_error&) {
    // The machine gives no more threads; the run goes on without, and stores what it has at its end.
  }
}

EverySecond::~EverySecond() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

}  // namespace acstudy
