#pragma once

/// @file
/// Synthetic series whose right verdict is known from how they are made: what every judge of convergence must pass.

#include <functional>
#include <string>
#include <vector>

#include "reports/judging/orders.hpp"

namespace acstudy {

struct CorpusEntry {
  std::string name;
  std::vector<Level> levels;   ///< coarse to fine, but in entries about levels in another order
  double theory_order;         ///< 0: the error must settle
  std::vector<Verdict> right;  ///< more than one only where each is right
  std::string why;             ///< why that is right, whatever a judge says
  JudgeOptions options = {};   ///< what is known besides
};

/// The corpus, the same in every call: random numbers come from fixed seeds.
std::vector<CorpusEntry> verdict_corpus();

/// The verdict of some judge; `judge` itself by default.
using Judge = std::function<Verdict(const CorpusEntry&)>;

struct Misjudged {
  CorpusEntry entry;
  Verdict verdict;
};

/// The entries of the corpus on which the judge is wrong.
std::vector<Misjudged> misjudged_by(const Judge& judge);
std::vector<Misjudged> misjudged();

}  // namespace acstudy
