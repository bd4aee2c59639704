#pragma once

/// @file
/// Integrals of kernels without their closed forms: by quadrature, and from the B-spline itself.

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

namespace acstudy::test {

/// int_a^b z^power eta(z) dz where the integrand is smooth on (a, b), singular at most at a = 0, by Gauss-Kronrod in
/// a variable that makes every power z^p, p > -1, harmless: z = b s^20 from the origin, z = a (b/a)^s elsewhere.
template <class K>
double smooth_kernel_integral(const K& kernel, int power, double a, double b) {
  if (!(a < b)) return 0.0;
  const auto weighted = [&](double z, double dz) { return std::pow(z, power) * kernel.eta(z) * dz; };
  const auto from_origin = [&](double s) { return weighted(b * std::pow(s, 20), 20.0 * b * std::pow(s, 19)); };
  const double ratio = std::log1p((b - a) / a);
  const auto elsewhere = [&](double s) {
    const double z = a * std::exp(ratio * s);
    return weighted(z, z * ratio);
  };
  using Rule = boost::math::quadrature::gauss_kronrod<double, 31>;
  return a == 0.0 ? Rule::integrate(from_origin, 0.0, 1.0, 8, 1e-14) : Rule::integrate(elsewhere, 0.0, 1.0, 8, 1e-14);
}

/// int_a^b z^power eta(z) dz, split at 1/2, where the spline is not smooth.
template <class K>
double kernel_integral(const K& kernel, int power, double a, double b) {
  return smooth_kernel_integral(kernel, power, a, std::min(b, 0.5)) +
         smooth_kernel_integral(kernel, power, std::max(a, 0.5), b);
}

/// The cubic B-spline as printed, on |z| <= 2.
inline double rho(double z) {
  z = std::abs(z);
  if (z <= 1.0) return 2.0 / 3.0 * (1.0 - 1.5 * z * z + 0.75 * z * z * z);
  return z <= 2.0 ? std::pow(2.0 - z, 3) / 6.0 : 0.0;
}

}  // namespace acstudy::test
