#pragma once

/// @file
/// What a run shows on the terminal, and what it does once a second.

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

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
  /// Seconds that the cases take yet, or the findings if there are all cases; nothing where nobody knows.
  std::optional<double> left(double now) const;

  /// Something is done, and goes on: where the last case is, findings wait for those of other studies.
  bool begun() const { return findings_done > 0 || (cases_done > 0 && cases_done < cases); }
  bool done() const { return cases_done == cases && findings_done == findings; }
};

/// A study in the progress of a run.
struct StudyPace {
  std::string name;
  Pace pace = {};

  /// "map   43 %  120 of 2304 cases, about 34 s left", the name as wide as `width`.
  /// @param most  the seconds that all studies take yet, if somebody knows
  std::string line(double now, std::size_t width, std::optional<double> most) const;
  /// "map  2304 cases, 40 findings, 12 s"
  std::string last_line(double seconds, std::size_t width) const;
};

/// A line per study that is being run, and one for all, at the end of the terminal, rewritten as they change; a study
/// that is done leaves its line. A single study has the line for all alone. Silent where stderr is no terminal. Any
/// thread may call it.
class Progress {
 public:
  /// Shows the lines at once.
  /// @param studies  with what there is to do of each
  /// @param all      of all of them: a case that several want is one
  Progress(std::vector<StudyPace> studies, const Pace& all, bool quiet);
  /// Removes them.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// One case more that these studies want.
  void case_added(double work, const std::vector<std::size_t>& studies);
  /// A case is done that these studies want.
  void case_done(double work, const std::vector<std::size_t>& studies);
  void finding_done(std::size_t study);
  /// A study has all of its results.
  /// @param seconds  of processors, that it took
  void study_done(std::size_t study, double seconds);
  /// Shows how much time has passed.
  void show();

 private:
  double now() const;
  std::vector<std::string> lines_at(double seconds) const;
  void write();
  /// What removes the lines from the terminal.
  std::string erased();

  std::mutex mutex_;
  std::vector<StudyPace> studies_;
  std::size_t name_width_ = 0;
  Pace all_;
  bool silent_;
  std::size_t lines_ = 0;  ///< that stand on the terminal
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now(), written_ = {};
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
