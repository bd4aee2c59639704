#pragma once

/// @file
/// Sums of charges over distance between boxes of equal width, by sums of exponentials.

#include "solver/line/far/exponential_sum.hpp"

namespace acstudy::far {

/// With zeros up to a multiple of the lanes.
consteval int padded(int terms) { return (terms + 7) / 8 * 8; }

/// 1/s as a sum of exponentials, s in widths of a box, with each exponential as a polynomial over a box:
///
///   exp(-rate_m (1 - tau)/2) = sum_n in[n][m] tau^n      from a particle at tau to the right edge of its box
///   weight_m exp(-rate_m (1 + t)/2) = sum_n out[m][n] t^n   from the left edge of a box to a particle at t
///
/// with tau and t from -1 to 1 over a box; far from it tau may be somewhat less. Terms m from `count` to
/// `padded_count`, a multiple of eight, have weight 0.
template <int terms>
struct BoxExpansion {
  int count, padded_count;
  alignas(64) double rate[ExponentialSum::capacity];
  alignas(64) double decay[ExponentialSum::capacity];  ///< exp(-rate)
  alignas(64) double in[terms][ExponentialSum::capacity];
  alignas(64) double out[ExponentialSum::capacity][padded(terms)];
};

/// The expansions of a horizon of so many boxes, for kernels of one piece and of two. With as many terms as they have,
/// what is lost is round-off.
template <bool two_pieces>
struct BoxTables;

template <>
struct BoxTables<false> {
  static constexpr int inner_terms = 20;
  int boxes;
  BoxExpansion<inner_terms> inner;  ///< from one box apart up to the horizon
};

template <>
struct BoxTables<true> {
  /// Of the inner piece m/z is a polynomial but for a small part: some 1e-12 of that are lost between boxes that are
  /// one box apart, and round-off between others.
  static constexpr int inner_terms = 16;
  static constexpr int outer_terms = 14;
  int boxes;
  BoxExpansion<inner_terms> inner;  ///< from one box apart up to half of the horizon
  BoxExpansion<outer_terms> outer;  ///< from half of the horizon up to all of it
};

/// Tables for boxes of about `per_box` particles, where a horizon holds so many neighbors on a side; null where they
/// are too few for boxes to be worth anything. Computed at the first call, in some 20 milliseconds, and kept; safe to
/// call from several threads.
template <bool two_pieces>
const BoxTables<two_pieces>* box_tables(double neighbors, double per_box);

}  // namespace acstudy::far
