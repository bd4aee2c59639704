#pragma once

/// @file
/// Saves what is finished of studies that are not.

#include <exception>
#include <filesystem>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "studies/storing/journal.hpp"

namespace acstudy {

/// The journals of the studies of a run. A study has one while it is not finished.
class Journals {
 public:
  /// @param mutex  guards the results; all functions but save() are called with it locked
  /// @param suffix  see `Shard::suffix`
  Journals(const std::filesystem::path& out, std::string suffix, const std::vector<StudyResult>& studies,
           std::mutex& mutex)
      : out_(out),
        suffix_(std::move(suffix)),
        studies_(studies),
        mutex_(mutex),
        unsaved_(studies.size()),
        begun_(studies.size()),
        finished_(studies.size()) {}

  /// What save() is to save next of a study.
  Finished& unsaved(std::size_t study) { return unsaved_[study]; }
  /// The result file of a study has all.
  void finish(std::size_t study) {
    finished_[study] = true;
    unsaved_[study] = {};
  }
  bool finished(std::size_t study) const { return finished_[study]; }

  /// Appends what is not saved yet. A disk that is full now may not be later, and the run goes on.
  /// @return what went wrong, if something did
  std::exception_ptr save();

 private:
  std::filesystem::path out_;
  std::string suffix_;
  const std::vector<StudyResult>& studies_;
  std::mutex& mutex_;
  std::vector<Finished> unsaved_;
  std::vector<bool> begun_, finished_;
};

}  // namespace acstudy
