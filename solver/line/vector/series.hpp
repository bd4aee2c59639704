#pragma once

/// @file
/// Trigonometric series at several points at a time.

#include "solver/line/vector/lanes.hpp"
#include "solver/line/vector/sweeps.hpp"

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

/// For few modes: with cos(n w x) = T_n(C) and sin(n w x) = S U_{n-1}(C), the polynomials of Chebyshev, the series is
/// P(C) + S Q(C), whose coefficients stay in registers.
template <int highest>
inline void evaluate_few_modes(const SweepSeries& series, const double* cosine, const double* sine, double* out,
                               std::ptrdiff_t count) {
  double P[highest + 1] = {series.constant}, Q[highest + 1] = {};
  double T_before[highest + 1] = {1.0}, T[highest + 1] = {0.0, 1.0}, U_before[highest + 1] = {}, U[highest + 1] = {1.0};
  for (int n = 1; n <= highest; ++n) {
    for (int k = highest; k >= 0; --k) {
      P[k] += series.cosine[n - 1] * T[k];
      Q[k] += series.sine[n - 1] * U[k];
      const double T_next = (k > 0 ? 2.0 * T[k - 1] : 0.0) - T_before[k];
      const double U_next = (k > 0 ? 2.0 * U[k - 1] : 0.0) - U_before[k];
      T_before[k] = T[k];
      U_before[k] = U[k];
      T[k] = T_next;
      U[k] = U_next;
    }
  }
  Lanes p[highest + 1], q[highest];
  for (int k = 0; k <= highest; ++k) p[k] = spread(P[k]);
  for (int k = 0; k < highest; ++k) q[k] = spread(Q[k]);
  at_all_points(cosine, sine, out, count, [&](Lanes C, Lanes S) {
    Lanes of_C = p[highest], by_S = q[highest - 1];
    for (int k = highest - 1; k >= 0; --k) of_C = of_C * C + p[k];
    for (int k = highest - 2; k >= 0; --k) by_S = by_S * C + q[k];
    return of_C + S * by_S;
  });
}

/// Horner's rule in e^{i w x}: the real part of sum_n (cosine_n - i sine_n) e^{i n w x}. Polynomials in C lose digits
/// with n.
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
