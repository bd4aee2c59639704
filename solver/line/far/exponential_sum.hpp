#pragma once

/// @file
/// The reciprocal as a sum of exponentials, which makes far sums one-term recursions.

#include <cstddef>

namespace acstudy::far {

/// 1/s = sum_m weight_m exp(-rate_m s) on 1 <= s <= ratio, to `error` relative.
///
/// Stored for vectors of eight: the terms from `count` to `padded`, a multiple of eight, have weight 0.
struct ExponentialSum {
  static constexpr int capacity = 64;
  int count = 0, padded = 0;
  double ratio = 1.0;
  double error = 0.0;  ///< largest relative error on a grid much finer than the one it was fitted on
  alignas(64) double rate[capacity] = {};
  alignas(64) double weight[capacity] = {};
};

/// The sum for the ratio 2^log2_ratio, computed at the first call and kept; safe to call from several threads.
///
/// 1/s = int_0^inf exp(-s r) dr. Of rates that cover [0.1/ratio, 30] densely, a QR decomposition with column pivoting
/// picks as many as reach round-off. Smaller rates are not needed and would spoil differences of prefix sums: they
/// remember particles for longer than the window lasts.
/// @pre 1 <= log2_ratio <= max_log2_ratio
const ExponentialSum& reciprocal_sum(int log2_ratio);

inline constexpr int max_log2_ratio = 8;

/// The same with a given number of terms, however inaccurate.
/// @pre 1 <= count <= ExponentialSum::capacity
ExponentialSum reciprocal_sum(int log2_ratio, int count);

}  // namespace acstudy::far
