#pragma once

/// @file
/// Trigonometric series at several points at a time.

#include "solver/vector/lanes.hpp"
#include "solver/vector/sweeps.hpp"

namespace acstudy {
inline namespace ACSTUDY_ISA {

/// Horner's rule in e^{i w x}: the real part of sum_n (cosine_n - i sine_n) e^{i n w x}.
inline void evaluate_series(const SweepSeries& series, const double* half_cosine, const double* half_sine, double* out,
                            std::ptrdiff_t count) {
  const auto at = [&](Lanes C_half, Lanes S_half) {
    const Lanes C = 1.0 - 2.0 * S_half * S_half, S = 2.0 * S_half * C_half;
    Lanes real = {}, imaginary = {};
    for (std::ptrdiff_t n = series.highest; n > 0; --n) {
      const Lanes a = real + series.cosine[n - 1], b = imaginary - series.sine[n - 1];
      real = a * C - b * S;
      imaginary = a * S + b * C;
    }
    return series.constant + real;
  };
  std::ptrdiff_t i = 0;
  for (; i + lane_count <= count; i += lane_count) store(out + i, at(load(half_cosine + i), load(half_sine + i)));
  if (i == count) return;
  // The rest as a whole vector: the value at a point must not depend on where in the array it stands.
  double C[lane_count] = {}, S[lane_count] = {}, last[lane_count];
  for (std::ptrdiff_t k = i; k < count; ++k) {
    C[k - i] = half_cosine[k];
    S[k - i] = half_sine[k];
  }
  store(last, at(load(C), load(S)));
  for (std::ptrdiff_t k = i; k < count; ++k) out[k] = last[k - i];
}

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
