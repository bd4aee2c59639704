#pragma once

/// @file
/// How the work of studies is shared out to runs that know nothing of one another.

#include <cstddef>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "studies/cases/study.hpp"

namespace acstudy {

/// The share that a run does: one of so many.
struct Shard {
  int number = 1, count = 1;  ///< number from 1 to count

  bool whole() const { return count == 1; }
  /// What names of its files have behind that of the study: ".3-of-16"; nothing if it does all.
  std::string suffix() const;
  /// "3/16"
  std::string label() const;
};

/// The shares of all cases, and of the measurements that rest on no case of their study. They depend on the studies and
/// the number of shares alone, on no machine and on nothing that is stored; by estimated work they are about equal.
/// Cases that differ by divergence or source alone, which save work together, have one share, and so have all levels of
/// a series that adds levels until it is decided.
class Shares {
 public:
  Shares(const std::vector<Study>& studies, int count);

  /// From 1 on.  @pre the case is one of a study
  int of(const Case& c) const { return count_ == 1 ? 1 : of_case_.at(c.key()); }
  /// Nothing, 0, for a measurement that is taken when all cases are there.
  int of(std::size_t study, std::size_t measurement) const {
    const auto found = of_measurement_.find(study);
    return found == of_measurement_.end() ? 0 : found->second[measurement];
  }

 private:
  int count_;
  std::unordered_map<std::string, int> of_case_;
  std::unordered_map<std::size_t, std::vector<int>> of_measurement_;
};

}  // namespace acstudy
