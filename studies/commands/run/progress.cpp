#include "studies/commands/run/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <optional>
#include <system_error>
#include <utility>

namespace acstudy {

namespace {

/// "0 of 4 findings"
std::string count_text(std::size_t done, std::size_t all, const char* what) {
  return fmt::format("{} of {} {}", done, all, what);
}

}  // namespace

std::string Pace::line(double now) const {
  std::string text;
  if (cases > 0 || findings == 0) text = count_text(cases_done, cases, "cases");
  if (findings > 0) text += (text.empty() ? "" : " and ") + count_text(findings_done, findings, "findings");
  text += fmt::format(", {:.0f} s", std::floor(now));

  const bool cases_open = cases_done < cases, findings_open = findings_done < findings;
  std::optional<double> left;
  if (cases_open) {
    if (work_done > 0.0) left = now * (work - work_done) / work_done;
  } else if (findings_open) {
    const auto done = static_cast<double>(findings_done), open = static_cast<double>(findings - findings_done);
    if (findings_done > 0) left = (now - cases_ended) * open / done;
  } else {
    left = 0.0;
  }
  if (!left) return text;
  return text +
         fmt::format(", about {:.0f} s left{}", std::ceil(*left), cases_open && findings_open ? " for the cases" : "");
}

Progress::Progress(std::size_t cases, double work, std::size_t findings)
    : pace_{.cases = cases, .work = work, .findings = findings}, on_terminal_(isatty(STDERR_FILENO) != 0) {
  if (cases > 0 || findings > 0) show();
}

Progress::~Progress() {
  if (on_terminal_) std::fputs("\r\033[K", stderr);
}

void Progress::case_done(double work) {
  const std::lock_guard lock(mutex_);
  ++pace_.cases_done;
  pace_.work_done += work;
  if (pace_.cases_done == pace_.cases) pace_.cases_ended = now();
  write();
}

void Progress::finding_done() {
  const std::lock_guard lock(mutex_);
  ++pace_.findings_done;
  write();
}

void Progress::show() {
  const std::lock_guard lock(mutex_);
  write();
}

double Progress::now() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Progress::write() {
  if (!on_terminal_) return;
  // fputs and not fmt::print, which throws: a terminal that has gone away must not end the run.
  std::fputs(("\r\033[K" + pace_.line(now())).c_str(), stderr);
  std::fflush(stderr);
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
