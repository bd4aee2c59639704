#pragma once

/// @file
/// Models of a value under refinement whose limit is not known: phi_0 + C v^p, with and without a correction.
///
/// Where printed digits explain the scatter of the values (no more of it than chance makes in half of all cases) it is
/// taken for that; otherwise it is in proportion to their errors, C v^p, and no less than digits leave open. Each model
/// is weighted least squares at the actual variable of each level, linear in all but p; the interval is that of the
/// profile over p. Preconditions throughout: levels from coarse to fine, variables positive and falling strictly,
/// values finite and not all equal.

#include <optional>
#include <span>
#include <vector>

#include "reports/judging/fits.hpp"

namespace acstudy {

/// A functional or norm of the solution on one level.
struct Value {
  double variable;
  double value;
  double digits = 0.0;  ///< half a unit in the last printed place; 0: not known
};

/// How much a value changes from one level to the next finer one.
struct Difference {
  double variable, finer;  ///< of the two levels
  double difference;
  double digits = 0.0;  ///< what printed digits leave open
};

/// value = phi_0 + C v^p (1 + D v^q). The estimate is that of p; `value` and its 95 % interval are those of phi_0. Ends
/// of intervals are infinite where the levels set no bound.
struct ValueLaw : Estimate {
  double value = not_estimated, value_low = not_estimated, value_high = not_estimated;
  double C = not_estimated, D = not_estimated, q = not_estimated;
};

/// The law without correction (D = 0), from four levels on.
ValueLaw fit_value_law(std::span<const Value> values);

/// The law with a correction, from five levels on. The interval unites those of q = 1/2, 1 and 2, of all that the
/// levels do not exclude; at the coarsest level D v^q stays between -0.95 and 3, as in `fit_corrected_law`.
ValueLaw fit_corrected_value_law(std::span<const Value> values);

/// The one that is reported: with a correction where there are levels for it.
ValueLaw reported_value_law(std::span<const Value> values);

/// The changes from each level to the next; what digits leave open adds up.
std::vector<Difference> differences_of(std::span<const Value> values);

/// The p with which two successive differences are C (v_1^p - v_2^p) and C (v_2^p - v_3^p): the order of three levels,
/// at any ratios. Where the differences have opposite signs, that of C (v_1^p + v_2^p) and so on, as for values that
/// alternate about their limit. nothing if there is none between -20 and 20.
std::optional<double> order_between(const Difference& coarse, const Difference& fine);

/// The error that a difference stands for, as a level: C v^p at a variable v between its two, C = difference/(v_1^p -
/// v_2^p). v is chosen so that the level has the right order even where it is not p, but close to it; at equal ratios
/// it is so for any p.
Level level_of(const Difference& difference, double p);

}  // namespace acstudy
