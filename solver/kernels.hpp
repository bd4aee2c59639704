#pragma once

/// @file
/// Interaction kernels and their cell moments in closed form.

#include <algorithm>
#include <cmath>
#include <concepts>
#include <span>
#include <stdexcept>

#include "solver/line/cells.hpp"

namespace acstudy {

/// Role of a kernel: the one-sided profile eta on the unit horizon, from which both models are built.
///
/// At horizon delta the upwind kernel of Model I is eta^delta(s) = eta(s/delta)/delta^2 on (0, delta); the
/// antisymmetric kernel of Model II is w^delta(z) = sign(z) eta^delta(|z|)/2. With the first moment normalized to one,
/// (2.3) and its twin for w^delta both hold.
///
/// | expression             | meaning                                                                                |
/// |------------------------|----------------------------------------------------------------------------------------|
/// | `k.eta(z)`             | eta(z) >= 0, 0 < z < 1                                                                  |
/// | `k.first_moment(z)`    | int_0^z r eta(r) dr, nondecreasing, 0 at z = 0 and 1 at z = 1                           |
/// | `k.first_moment(cell)` | int r eta(r) dr over the cell, >= 0, to some units in the last place, however narrow    |
/// | `k.origin_exponent()`  | a < 2 such that z^a eta(z) is smooth up to z = 0                                        |
/// | `k.regular_part(z)`    | z^a eta(z), 0 <= z <= 1                                                                 |
/// | `k.breaks()`           | the interior points where eta is not smooth, in increasing order                       |
///
/// Arguments are distances in units of the horizon, 0 <= z <= 1.
template <class K>
concept Kernel = requires(const K k, double z, const Cell& cell) {
  { k.eta(z) } -> std::same_as<double>;
  { k.first_moment(z) } -> std::same_as<double>;
  { k.first_moment(cell) } -> std::same_as<double>;
  { k.origin_exponent() } -> std::same_as<double>;
  { k.regular_part(z) } -> std::same_as<double>;
  { k.breaks() } -> std::same_as<std::span<const double>>;
};

/// A kernel that Model II can use as well: eta itself is integrable, so that its cell integrals exist (3.3).
///
/// | expression     | meaning                                                    |
/// |----------------|------------------------------------------------------------|
/// | `k.mass(z)`    | int_0^z eta(r) dr, nondecreasing                           |
/// | `k.mass(cell)` | int eta(r) dr over the cell, >= 0, as exact as the moment  |
template <class K>
concept IntegrableKernel = Kernel<K> && requires(const K k, double z, const Cell& cell) {
  { k.mass(z) } -> std::same_as<double>;
  { k.mass(cell) } -> std::same_as<double>;
};

// Over a cell [a, b] the difference f(b) - f(a) of closed forms would lose the digits that both ends have in common: 4
// to 13 of them at a horizon of 1e4 spacings. Factored, with the width of the cell in front, it loses none.

/// eta(z) = 1/z: the singular kernel of section 4.1. Its cell moments are the cell lengths.
struct InverseKernel {
  double eta(double z) const { return 1.0 / z; }
  double first_moment(double z) const { return z; }
  double first_moment(const Cell& cell) const { return cell.width; }
  double origin_exponent() const { return 1.0; }
  double regular_part(double) const { return 1.0; }
  std::span<const double> breaks() const { return {}; }
};

/// b^p - a^p = -b^p expm1(p log(a/b)) over a cell [a, b], p > 0.
inline double power_difference(const Cell& cell, double p) {
  const double b_p = std::pow(cell.outer, p);
  if (cell.inner == 0.0) return b_p;
  const double log_ratio = cell.width < 0.5 * cell.outer ? std::log1p(-cell.width / cell.outer)  //
                                                         : std::log(cell.inner / cell.outer);
  return b_p * -std::expm1(p * log_ratio);
}

/// eta(z) = (2 - alpha) z^(-alpha), alpha < 2, for Model I.
class PowerKernel {
 public:
  /// @throws std::invalid_argument unless alpha is finite and below 2 (the first moment diverges otherwise).
  explicit PowerKernel(double alpha) : alpha_(alpha) {
    if (!std::isfinite(alpha) || alpha >= 2.0) throw std::invalid_argument("power kernel needs a finite alpha < 2");
  }
  double alpha() const { return alpha_; }
  double eta(double z) const { return (2.0 - alpha_) * std::pow(z, -alpha_); }
  double first_moment(double z) const { return std::pow(z, 2.0 - alpha_); }
  double first_moment(const Cell& cell) const { return power_difference(cell, 2.0 - alpha_); }
  double origin_exponent() const { return alpha_; }
  double regular_part(double) const { return 2.0 - alpha_; }
  std::span<const double> breaks() const { return {}; }

 private:
  double alpha_;
};

/// The power family where it is integrable, alpha < 1, for Model II.
class IntegrablePowerKernel : public PowerKernel {
 public:
  /// @throws std::invalid_argument unless alpha is finite and below 1.
  explicit IntegrablePowerKernel(double alpha) : PowerKernel(alpha) {
    if (alpha >= 1.0) throw std::invalid_argument("integrable power kernel needs alpha < 1");
  }
  double mass(double z) const { return (2.0 - alpha()) / (1.0 - alpha()) * std::pow(z, 1.0 - alpha()); }
  double mass(const Cell& cell) const {
    return (2.0 - alpha()) / (1.0 - alpha()) * power_difference(cell, 1.0 - alpha());
  }
};

/// The derivative of the cubic B-spline rho, whose support |zeta| <= 2 is scaled onto the horizon (zeta = 2 z):
/// eta(z) = -8 rho'(2 z). Model I uses it as its upwind kernel (section 4.3), Model II as its odd extension.
struct CubicSplineKernel {
  double eta(double z) const {
    const double zeta = 2.0 * z;
    return zeta <= 1.0 ? zeta * (16.0 - 12.0 * zeta) : 4.0 * (2.0 - zeta) * (2.0 - zeta);
  }
  double mass(double z) const {
    const double zeta = 2.0 * z, y = 2.0 - zeta;
    return zeta <= 1.0 ? zeta * zeta * (4.0 - 2.0 * zeta) : (8.0 - 2.0 * y * y * y) / 3.0;
  }
  double first_moment(double z) const {
    const double zeta = 2.0 * z, y = 2.0 - zeta;
    return zeta <= 1.0 ? zeta * zeta * zeta * (4.0 / 3.0 - 0.75 * zeta) : 1.0 - y * y * y * (2.0 / 3.0 - 0.25 * y);
  }
  double mass(const Cell& cell) const {
    const auto inside = [](double width, double sum, double product) { return width * (sum * (1.0 - sum) + product); };
    const auto outside = [](double width, double sum, double product) { return width * (sum * sum - product) / 3.0; };
    return 16.0 * cut(cell, inside, outside);
  }
  double first_moment(const Cell& cell) const {
    const auto inside = [](double width, double sum, double product) {
      return width * (sum * sum * (8.0 - 9.0 * sum) - product * (8.0 - 18.0 * sum));
    };
    const auto outside = [](double width, double sum, double product) {
      return width * (sum * sum * (4.0 - 3.0 * sum) - product * (4.0 - 6.0 * sum));
    };
    return 4.0 / 3.0 * cut(cell, inside, outside);
  }
  double origin_exponent() const { return 0.0; }
  double regular_part(double z) const { return eta(z); }
  std::span<const double> breaks() const { return break_; }

 private:
  static constexpr double break_[] = {0.5};

  /// A cell cut at z = 1/2. Both parts are polynomials with their width as a factor: inside in the distances of the two
  /// ends, outside in their distances to the horizon, and of these in the sum and the product.
  template <class Inside, class Outside>
  static double cut(const Cell& cell, Inside inside, Outside outside) {
    const auto [a, b, width, rest_a, rest_b] = cell;
    if (b <= 0.5) return inside(width, a + b, a * b);
    if (rest_a <= 0.5) return outside(width, rest_a + rest_b, rest_a * rest_b);
    // Round-off in where it is cut is harmless: the widths add up to that of the cell, and eta is continuous.
    const double width_inside = std::clamp(0.5 - a, 0.0, width);
    return inside(width_inside, a + 0.5, a * 0.5) + outside(width - width_inside, 0.5 + rest_b, 0.5 * rest_b);
  }
};

}  // namespace acstudy
