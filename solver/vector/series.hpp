#pragma once

/// @file
/// Trigonometric series at several points at a time.

#include "solver/vector/lanes.hpp"
#include "solver/vector/sweeps.hpp"

namespace acstudy {
inline namespace ACSTUDY_ISA {

/// out[i] = at(cosine[i], sine[i])
template <class At>
inline void at_all_points(const double* cosine, const double* sine, double* out, std::ptrdiff_t count, const At& at) {
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

/// Clenshaw's rule, for few modes: with b_n = a_n + 2 cos(w x) b_{n+1} - b_{n+2} a sum of a_n cos(n w x) from n = 0 on
/// is a_0 + cos(w x) b_1 - b_2, and one of a_n sin(n w x) is sin(w x) b_1. Coefficients stay in registers.
template <int highest>
inline void evaluate_few_modes(const SweepSeries& series, const double* cosine, const double* sine, double* out,
                               std::ptrdiff_t count) {
  Lanes a[highest + 1], b[highest + 1];
  for (int n = 1; n <= highest; ++n) {
    a[n] = spread(series.cosine[n - 1]);
    b[n] = spread(series.sine[n - 1]);
  }
  const Lanes constant = spread(series.constant);
  at_all_points(cosine, sine, out, count, [&](Lanes C, Lanes S) {
    const Lanes twice = C + C;
    Lanes of_cosine = a[highest], of_cosine_after = {}, of_sine = b[highest], of_sine_after = {};
    for (int n = highest - 1; n > 0; --n) {
      const Lanes next_of_cosine = (a[n] - of_cosine_after) + twice * of_cosine;
      const Lanes next_of_sine = (b[n] - of_sine_after) + twice * of_sine;
      of_cosine_after = of_cosine;
      of_cosine = next_of_cosine;
      of_sine_after = of_sine;
      of_sine = next_of_sine;
    }
    return (constant - of_cosine_after) + C * of_cosine + S * of_sine;
  });
}

/// Horner's rule in e^{i w x}: the real part of sum_n (cosine_n - i sine_n) e^{i n w x}. Clenshaw's loses digits with n
/// where sin(w x) is small.
inline void evaluate_modes(const SweepSeries& series, const double* cosine, const double* sine, double* out,
                           std::ptrdiff_t count) {
  const auto [constant, a, b, highest] = series;
  at_all_points(cosine, sine, out, count, [=](Lanes C, Lanes S) {
    Lanes real = {}, imaginary = {};
    for (std::ptrdiff_t n = highest; n > 0; --n) {
      const Lanes of_cosine = real + a[n - 1], of_sine = imaginary - b[n - 1];
      real = of_cosine * C - of_sine * S;
      imaginary = of_cosine * S + of_sine * C;
    }
    return constant + real;
  });
}

inline void evaluate_series(const SweepSeries& series, const double* cosine, const double* sine, double* out,
                            std::ptrdiff_t count) {
  switch (series.highest) {
    case 0:
      for (std::ptrdiff_t i = 0; i < count; ++i) out[i] = series.constant;
      return;
    case 1:
      return evaluate_few_modes<1>(series, cosine, sine, out, count);
    case 2:
      return evaluate_few_modes<2>(series, cosine, sine, out, count);
    case 3:
      return evaluate_few_modes<3>(series, cosine, sine, out, count);
    default:
      return evaluate_modes(series, cosine, sine, out, count);
  }
}

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
