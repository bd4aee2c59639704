#pragma once

/// @file
/// How fast this machine runs cases, from short runs that are done once.

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "studies/running/plan.hpp"

namespace acstudy {

/// Seconds that a unit of estimated work takes, by what is run: scene, scheme, source, steps and form. Kept in the
/// user's cache folder, a file for each machine and version; where that cannot be, known to this process alone.
class Speeds {
 public:
  /// Reads what earlier runs have found.
  Speeds();
  /// Keeps what is new, if it can be.
  ~Speeds();
  Speeds(const Speeds&) = delete;
  Speeds& operator=(const Speeds&) = delete;

  /// Seconds of a processor that a case takes by itself. Where its like has not been met, some steps of it are run, or
  /// of one with fewer particles: some hundredths of a second. Nothing of a program, and of what does not run.
  std::optional<double> seconds(const Plan& plan);

 private:
  std::filesystem::path file_;  ///< empty where there is no folder
  std::map<std::string, double> seconds_of_work_;
  bool changed_ = false;
};

}  // namespace acstudy
