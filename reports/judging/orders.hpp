#pragma once

/// @file
/// Observed order of convergence and the verdict on it.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "reports/judging/fits.hpp"
#include "reports/judging/window.hpp"

namespace acstudy {

enum class Verdict {
  confirmed,       ///< the order is theory's
  pre_asymptotic,  ///< the orders still move toward theory's, and the extrapolated order agrees with it
  below,           ///< converges, but more slowly than theory says
  above,           ///< converges faster than theory says
  stagnates,       ///< the error stops falling well above round-off
  floor,           ///< the error stops falling at round-off
  diverges,        ///< the error grows under refinement
  unstable,        ///< an error is not finite, or grows exponentially under refinement
  inconclusive,    ///< the levels do not settle the question; the reason says why
  holds,           ///< a bound or identity is met: not of an order
  violated,        ///< it is not
  determined,      ///< the order is sharp and undisputed, and no theory was given to compare it with
  stable,          ///< never given, only expected where no order can be seen: met by all but `unstable`
};

std::string_view name_of(Verdict verdict);
std::optional<Verdict> verdict_from(std::string_view name);

/// An order of convergence with its evidence; NaN where the levels allow no estimate.
///
/// The order with its interval is the one that the error has in the limit: that of `corrected` from four levels in the
/// window on, that of `fitted` for three. An interval that takes no correction into account misses the order of most
/// series that have one; where there is none the price is width.
struct Judgement : Estimate {
  double extrapolated = not_estimated;  ///< order of `corrected`
  std::vector<double> pairwise;         ///< order between each level and the next finer one, all levels
  Verdict verdict = Verdict::inconclusive;
  std::string reason;  ///< one sentence: the evidence

  Window window = {0, 0};  ///< the levels that the fits below use
  PowerLaw fitted;
  CorrectedLaw corrected;
  FlooredLaw floored;
  LeaveOneOut leave_one_out;  ///< of `fitted`; its level is an index into all levels
};

/// How far an observed order may lie from theory's and still agree with it.
inline constexpr double order_tolerance = 0.05;
/// The same for an extrapolated order, which three parameters fitted to few levels leave less sharp.
inline constexpr double extrapolation_tolerance = 0.1;
/// A power law whose order has a wider interval than this, on either side, confirms nothing.
inline constexpr double widest_half_width = 0.15;

struct JudgeOptions {
  /// Size of the solution; errors below 1e-12 times this are round-off. Not known: a floor has to show in the errors.
  std::optional<double> scale = {};
  /// Errors at or below this are known to be no more than a floor of round-off, quadrature or iteration.
  std::optional<double> floor = {};
};

/// Judges errors under refinement against theory's order.
///
/// Confirmed: order of the power law and last pairwise order lie within `order_tolerance` of theory's, the latter also
/// where the scatter of the levels explains its distance; no level carries the result alone, and the corrected law's
/// interval does not contradict.
/// Pre-asymptotic: not yet, but the pairwise orders move toward theory's, by a correction v^q with q >= 0.4, and the
/// corrected law's order lies within `extrapolation_tolerance` of it, or theory's order with such a correction fits as
/// well. Slower drifts, such as that of h log(1/h), never pass.
/// All bounds are two-sided, and nothing else passes.
///
/// @param levels        coarse to fine; anything else, like an error that is not finite or negative, has its verdict
/// @param theory_order  0 where theory says that the error settles at a positive value; NaN if there is no theory:
///                      then the verdict is what the levels alone show
Judgement judge(std::span<const Level> levels, double theory_order, const JudgeOptions& options);
Judgement judge(std::span<const Level> levels, double theory_order);

/// The same against several orders at once, which costs little more than against one.
std::vector<Judgement> judge(std::span<const Level> levels, std::span<const double> theory_orders,
                             const JudgeOptions& options);

/// True if the verdict is what a study expects; "confirmed" is met by `pre_asymptotic` too, since both say that
/// theory's order holds, and "stable" by every verdict but `unstable`.
bool meets(Verdict verdict, Verdict expected);

}  // namespace acstudy
