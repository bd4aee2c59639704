#pragma once

/// @file
/// Observed order of convergence and the verdict on it.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace acstudy {

/// One level of a refinement: the variable of theory (h, or max(h, delta)) and the error there.
struct Level {
  double variable;
  double error;
};

enum class Verdict {
  confirmed,       ///< the order is theory's
  pre_asymptotic,  ///< the orders still move toward theory's, and the extrapolated order agrees with it
  below,           ///< converges, but more slowly than theory says
  above,           ///< converges faster than theory says
  stagnates,       ///< the error stops falling well above round-off
  floor,           ///< the error stops falling at round-off
  diverges,        ///< the error grows under refinement
  unstable,        ///< an error is not finite, or grows exponentially under refinement
  inconclusive,    ///< too few levels, no error to speak of, or too wide an interval
  holds,           ///< a bound or identity is met: not of an order
  violated,        ///< it is not
};

std::string_view name_of(Verdict verdict);
std::optional<Verdict> verdict_from(std::string_view name);

/// An order of convergence with its evidence. Orders that could not be estimated are NaN.
struct Judgement {
  double order;                  ///< least-squares slope of log(error) over log(variable), all levels
  double low, high;              ///< its 95 % interval (Student t, levels - 2 degrees of freedom)
  double extrapolated;           ///< p of error = C v^p (1 + D v), from four levels on
  std::vector<double> pairwise;  ///< order between each level and the next finer one
  Verdict verdict;
  std::string reason;  ///< one sentence: the evidence
};

/// How far an observed order may lie from theory's and still agree with it.
inline constexpr double order_tolerance = 0.05;
/// The same for an extrapolated order, which three parameters fitted to few levels leave less sharp.
inline constexpr double extrapolation_tolerance = 0.1;

/// Judges errors under refinement against theory's order.
///
/// Confirmed means: the fitted order and the last pairwise order lie within `order_tolerance` of theory's.
/// Pre-asymptotic means: they do not yet, but each pairwise order is closer to theory's than the one before, and the
/// extrapolated order lies within `extrapolation_tolerance`. Both bounds are two-sided. Nothing else passes: a level
/// that is not finite, zero or negative, a growing error or fewer than three levels have verdicts of their own.
///
/// @param levels        coarse to fine; the actual variable of each level, so any refinement ratio is right
/// @param theory_order  0 where theory says that the error does not vanish
Judgement judge(std::span<const Level> levels, double theory_order);

/// True if the verdict is what a study expects; "confirmed" is met by `pre_asymptotic` too, since both say that
/// theory's order holds.
bool meets(Verdict verdict, Verdict expected);

}  // namespace acstudy
