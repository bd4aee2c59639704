#pragma once

/// @file
/// The questions that a judgement asks of errors and their fits, one after the other, until one has an answer.

#include <string>

#include "reports/judging/orders.hpp"

namespace acstudy {

struct Conclusion {
  Verdict verdict;
  std::string reason;
};

/// The verdict on finite, positive errors.
/// @param theory_order  0: the error must settle; NaN: there is no theory
/// @param result        with all estimates
Conclusion conclude(LevelView levels, double theory_order, const Judgement& result, const JudgeOptions& options);

}  // namespace acstudy
