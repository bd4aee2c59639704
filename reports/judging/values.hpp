#pragma once

/// @file
/// The verdict on values without an exact solution: order of convergence, limit and uncertainty of the finest level.

#include <span>
#include <string>
#include <vector>

#include "reports/judging/orders.hpp"
#include "reports/judging/uncertainty.hpp"
#include "reports/judging/value_fits.hpp"

namespace acstudy {

/// The estimate is that of the order. NaN where the levels allow none.
///
/// From values it is that of `corrected` from five levels in the window on, that of `fitted` for four; three levels
/// solve exactly for the order, and have no interval. From differences it is that of `judge`.
struct ValueJudgement : Estimate {
  std::vector<Difference> differences;
  std::vector<double> pairwise;  ///< the order of each three successive levels, all levels
  Verdict verdict = Verdict::inconclusive;
  std::string reason;  ///< one sentence: the evidence

  std::size_t first = 0;  ///< index of the coarsest level that the fits use
  double extrapolated = not_estimated, extrapolated_low = not_estimated, extrapolated_high = not_estimated;
  ValueLaw fitted, corrected;
  Gci gci;
  LeastSquaresUncertainty least_squares;  ///< of all levels
};

/// Judges values under refinement against theory's order, by `judge` of the errors that their differences stand for.
///
/// Coarse levels before the last change of direction are left out if four or more follow. A verdict for or against
/// theory's order also needs the order of the values themselves: its interval contains theory's or excludes it.
/// Values that swing about their limit to the end have no order that could be judged.
///
/// @param values        coarse to fine
/// @param theory_order, options  as for `judge`
ValueJudgement judge_values(std::span<const Value> values, double theory_order, const JudgeOptions& options = {});

/// The same where only differences of successive levels are known, or their norms. There is no limit then.
/// @param differences  coarse to fine, each beginning where the one before ends
ValueJudgement judge_differences(std::span<const Difference> differences, double theory_order,
                                 const JudgeOptions& options = {});

}  // namespace acstudy
