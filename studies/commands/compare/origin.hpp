#pragma once

/// @file
/// Where two sets of results come from.

#include <set>
#include <string>
#include <vector>

#include "studies/commands/compare/comparison.hpp"

namespace acstudy {

/// One entry of the provenance of the studies that are in both sets.
struct Origin {
  std::string name;                     ///< "compiler"
  std::set<std::string> before, after;  ///< all values that it has
  bool decides = false;                 ///< numbers may differ where it does

  bool differs() const { return before != after || before.size() > 1; }
};

/// What is known of where the two come from but when, by which command and on how many processors.
std::vector<Origin> origins(const Comparison& comparison);

/// Both sets with where they come from, and what may be the cause where numbers differ.
/// @param all  every value as a whole, however many lines it takes
std::string origin_text(const Comparison& comparison, bool all);

}  // namespace acstudy
