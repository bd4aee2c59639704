#pragma once

/// @file
/// Quadrature for the nonlocal operators: Gauss rules for the measures that a kernel induces on its horizon.

#include <cstddef>
#include <functional>
#include <vector>

#include "solver/kernels.hpp"

namespace acstudy {

/// Nodes in units of the horizon, 0 < node < 1, and weights.
struct Rule {
  std::vector<double> node, weight;
  std::size_t size() const { return node.size(); }
};

/// What a quadrature needs to know of a kernel, without its type.
struct KernelProfile {
  double origin_exponent;                      ///< a such that z^a eta(z) is smooth up to z = 0
  std::function<double(double)> regular_part;  ///< z^a eta(z), 0 <= z <= 1
  std::vector<double> breaks;                  ///< interior points where eta is not smooth, in increasing order
};

template <Kernel K>
KernelProfile profile(K kernel) {
  const auto breaks = kernel.breaks();
  return {
      kernel.origin_exponent(), [kernel](double z) { return kernel.regular_part(z); }, {breaks.begin(), breaks.end()}};
}

/// A rule for int_0^1 f(z) z eta(z) dz, split at the kernel's breakpoints: Gauss-Jacobi on the piece at the origin,
/// which absorbs its singularity, Gauss-Legendre on the others.
/// @throws std::domain_error if the singularity is beyond double precision (alpha = -200, say)
Rule first_moment_rule(const KernelProfile& kernel, std::size_t points_per_piece);

/// The n-point Gauss rule for E(s) = int_s^1 eta(z) dz on (0, 1); its weights sum to one.
///
/// A nonlocal derivative is the average of the local one with this weight,
///
///     int_0^delta (g(x) - g(x - s)) eta^delta(s) ds = int_0^1 g'(x - delta s) E(s) ds,
///
/// and taken in this form it keeps full relative accuracy down to delta -> 0, where the difference cancels.
Rule derivative_rule(const KernelProfile& kernel, std::size_t points);

/// The n-point Gauss rule for s int_s^1 eta(z)/z dz on (0, 1), total weight 1/2, of Model II's viscous term:
///
///     int_0^delta (u(x+z) - 2u(x) + u(x-z))/z eta^delta(z)/2 dz = (1/2) int_0^1 Q(delta s) s int_s^1 eta(z)/z dz ds,
///     Q(r) = (u_x(x+r) - u_x(x-r))/r.
Rule viscous_rule(const KernelProfile& kernel, std::size_t points);

}  // namespace acstudy
