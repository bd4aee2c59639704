#pragma once

/// @file
/// Moments of the kernels in closed form, M_n = int_0^1 z^n eta(z) dz, and the Fourier symbols of the nonlocal
/// operators that follow from them. Exact references: no quadrature, no code of the product.

#include <cmath>
#include <complex>
#include <functional>

namespace acstudy::test {

/// M_n; n >= 1, and n = 0 for an integrable kernel.
using Moments = std::function<long double(int)>;

inline long double inverse_moment(int n) { return 1.0L / static_cast<long double>(n); }
inline Moments power_moments(double alpha) {
  return [alpha](int n) { return (2.0L - alpha) / (n + 1.0L - alpha); };
}
/// From rho = [(2 - zeta)_+^3 - 4 (1 - zeta)_+^3] / 6 and eta(z) = -8 rho'(2z), by parts.
inline long double spline_moment(int n) {
  return (32.0L - 16.0L * std::pow(0.5L, n)) / ((n + 1.0L) * (n + 2.0L) * (n + 3.0L));
}

/// Symbol of Model I's derivative: int_0^delta (1 - e^(-iks)) eta^delta(s) ds, by its power series, which converges for
/// every k delta; in long double its cancellation costs nothing up to k delta = 20.
inline std::complex<double> upwind_symbol(const Moments& M, double k, double delta) {
  const long double kd = static_cast<long double>(k) * delta;
  std::complex<long double> sum = 0.0L, term = -1.0L;
  for (int n = 1; n < 120; ++n) {
    term *= std::complex<long double>(0.0L, -kd) / static_cast<long double>(n);
    sum += term * M(n);
  }
  sum /= static_cast<long double>(delta);
  return {static_cast<double>(sum.real()), static_cast<double>(sum.imag())};
}

/// Symbol of int_{-delta}^{delta} w^delta(z) (u(x) + u(x+z)) dz: i int_0^delta sin(kz) eta^delta(z) dz.
inline std::complex<double> central_symbol(const Moments& M, double k, double delta) {
  return {0.0, upwind_symbol(M, k, delta).imag()};
}

/// Symbol of int_{-delta}^{delta} w^delta(z) (u(x+z) - u(x))/z dz: int_0^delta (cos(kz) - 1) eta^delta(z)/z dz.
inline double viscous_symbol(const Moments& M, double k, double delta) {
  const long double kd = static_cast<long double>(k) * delta;
  long double sum = 0.0L, term = 1.0L;
  for (int n = 1; n < 60; ++n) {
    term *= -kd * kd / ((2.0L * n - 1.0L) * (2.0L * n));
    sum += term * M(2 * n - 1);
  }
  return static_cast<double>(sum / (static_cast<long double>(delta) * delta));
}

}  // namespace acstudy::test
