#pragma once

/// @file
/// What a run shows on the terminal, and what it does once a second.

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace acstudy {

/// What is left of a run, by what is done of it. Times are in seconds from its start.
struct Pace {
  std::size_t cases = 0, cases_done = 0;
  double work = 0.0, work_done = 0.0;  ///< estimated work of all cases and of those done
  std::size_t findings = 0, findings_done = 0;
  double cases_ended = 0.0;  ///< when the last case was done; 0 if there is none

  /// "3 of 50 cases and 0 of 4 findings, 7 s, about 95 s left for the cases". Findings are taken when all cases are
  /// there; until one is, nobody knows how long they take and nothing is said of it.
  std::string line(double now) const;
};

/// A line on the terminal that is rewritten; silent where stderr is none. Any thread may call it.
class Progress {
 public:
  /// Shows the line at once.
  Progress(std::size_t cases, double work, std::size_t findings);
  /// Removes it.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void case_done(double work);
  void finding_done();
  /// Shows how much time has passed.
  void show();

 private:
  double now() const;
  void write();

  std::mutex mutex_;
  Pace pace_;
  bool on_terminal_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Calls a function once a second from a thread of its own, to the end of its life.
class EverySecond {
 public:
  explicit EverySecond(std::function<void()> what);
  ~EverySecond();
  EverySecond(const EverySecond&) = delete;
  EverySecond& operator=(const EverySecond&) = delete;

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace acstudy
