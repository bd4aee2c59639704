#pragma once

/// @file
/// Synthetic sequences of values whose right verdict is known from how they are made.

#include <string>
#include <vector>

#include "reports/judging/values.hpp"

namespace acstudy {

struct ValueEntry {
  std::string name;
  std::vector<Value> values;  ///< coarse to fine, but in entries about levels in another order
  double theory_order;
  std::vector<Verdict> right;  ///< more than one only where each is right
  std::string why;             ///< why that is right, whatever a judge says
};

/// The corpus, the same in every call: random numbers come from a fixed seed.
std::vector<ValueEntry> value_corpus();

}  // namespace acstudy
