#pragma once

/// @file
/// Sums of charges over distance between boxes of equal width, by sums of exponentials.

#include "solver/far/exponential_sum.hpp"

namespace acstudy::far {

/// Coefficients of the polynomials by which particles are seen from a box, and a box by particles, for a relative error
/// of 1e-15: of boxes that are at least one box apart, and of those that are at least four.
inline constexpr int near_terms = 20, far_terms = 14;
/// With zeros up to a multiple of the lanes.
constexpr int padded(int terms) { return (terms + 7) / 8 * 8; }

/// 1/s as a sum of exponentials, s in widths of a box, with each exponential as a polynomial over a box:
///
///   exp(-rate_m (1 - tau)/2) = sum_n in[n][m] tau^n      from a particle at tau to the right edge of its box
///   weight_m exp(-rate_m (1 + t)/2) = sum_n out[m][n] t^n   from the left edge of a box to a particle at t
///
/// with tau and t from -1 to 1 over a box. Terms m from `count` to `padded_count`, a multiple of eight, have weight 0.
template <int terms>
struct BoxExpansion {
  int count, padded_count;
  alignas(64) double rate[ExponentialSum::capacity];
  alignas(64) double decay[ExponentialSum::capacity];  ///< exp(-rate)
  alignas(64) double in[terms][ExponentialSum::capacity];
  alignas(64) double out[ExponentialSum::capacity][padded(terms)];
};

/// The expansions of a horizon of so many boxes.
struct BoxTables {
  int boxes;
  BoxExpansion<near_terms> whole;  ///< from one box apart up to the horizon
  BoxExpansion<near_terms> near;   ///< from one box apart up to half of it
  BoxExpansion<far_terms> far;     ///< from half of the horizon up to all of it
};

/// Tables for boxes of about `per_box` particles, where a horizon holds so many neighbors on a side; null where they
/// are too few for boxes to be worth anything. Computed at the first call and kept; safe to call from several threads.
const BoxTables* box_tables(double neighbors, double per_box);

}  // namespace acstudy::far
