#pragma once

/// @file
/// Trigonometric series at several points at a time.

#include "solver/vector/lanes.hpp"
#include "solver/vector/sweeps.hpp"

namespace acstudy {
inline namespace ACSTUDY_ISA {

/// Clenshaw's rule: with b_n = a_n + 2 cos(w x) b_{n+1} - b_{n+2} a sum of a_n cos(n w x) from n = 0 on is
/// a_0 + cos(w x) b_1 - b_2, and one of a_n sin(n w x) is sin(w x) b_1.
///
/// @tparam kept  the highest mode, whose coefficients then stay in registers; 0: any
template <int kept>
inline void evaluate_modes(const SweepSeries& series, const double* cosine, const double* sine, double* out,
                           std::ptrdiff_t count) {
  Lanes kept_cosine[kept + 1], kept_sine[kept + 1];
  for (int n = 1; n <= kept; ++n) {
    kept_cosine[n] = spread(series.cosine[n - 1]);
    kept_sine[n] = spread(series.sine[n - 1]);
  }
  const Lanes constant = spread(series.constant);
  const std::ptrdiff_t highest = kept > 0 ? kept : series.highest;
  const double *const all_cosine = series.cosine, *const all_sine = series.sine;
  const auto a = [&](std::ptrdiff_t n) { return kept > 0 ? kept_cosine[n] : spread(all_cosine[n - 1]); };
  const auto b = [&](std::ptrdiff_t n) { return kept > 0 ? kept_sine[n] : spread(all_sine[n - 1]); };
  const auto at = [&](Lanes C, Lanes S) {
    const Lanes twice = C + C;
    Lanes of_cosine = a(highest), of_cosine_after = {}, of_sine = b(highest), of_sine_after = {};
    for (std::ptrdiff_t n = highest - 1; n > 0; --n) {
      const Lanes next_of_cosine = (a(n) - of_cosine_after) + twice * of_cosine;
      const Lanes next_of_sine = (b(n) - of_sine_after) + twice * of_sine;
      of_cosine_after = of_cosine;
      of_cosine = next_of_cosine;
      of_sine_after = of_sine;
      of_sine = next_of_sine;
    }
    return (constant - of_cosine_after) + C * of_cosine + S * of_sine;
  };
  std::ptrdiff_t i = 0;
  for (; i + lane_count <= count; i += lane_count) store(out + i, at(load(cosine + i), load(sine + i)));
  if (i == count) return;
  // The rest as a whole vector: the value at a point must not depend on where in the array it stands.
  double C[lane_count] = {}, S[lane_count] = {}, last[lane_count];
  for (std::ptrdiff_t k = i; k < count; ++k) {
    C[k - i] = cosine[k];
    S[k - i] = sine[k];
  }
  store(last, at(load(C), load(S)));
  for (std::ptrdiff_t k = i; k < count; ++k) out[k] = last[k - i];
}

inline void evaluate_series(const SweepSeries& series, const double* cosine, const double* sine, double* out,
                            std::ptrdiff_t count) {
  switch (series.highest) {
    case 0:
      for (std::ptrdiff_t i = 0; i < count; ++i) out[i] = series.constant;
      return;
    case 1:
      return evaluate_modes<1>(series, cosine, sine, out, count);
    case 2:
      return evaluate_modes<2>(series, cosine, sine, out, count);
    case 3:
      return evaluate_modes<3>(series, cosine, sine, out, count);
    default:
      return evaluate_modes<0>(series, cosine, sine, out, count);
  }
}

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
