#pragma once

/// @file
/// Interaction kernels and their cell moments in closed form.

#include <cmath>
#include <concepts>
#include <numbers>
#include <stdexcept>

namespace acstudy {

/// Role of a kernel: the one-sided profile eta on the unit horizon, from which both models are built.
///
/// At horizon delta the upwind kernel of Model I is eta^delta(s) = eta(s/delta)/delta^2 on (0, delta); the
/// antisymmetric kernel of Model II is w^delta(z) = sign(z) eta^delta(|z|)/2. With the first moment normalized to one,
/// (2.3) and its twin for w^delta both hold.
///
/// | expression            | meaning                                                                                 |
/// |-----------------------|-----------------------------------------------------------------------------------------|
/// | `k.eta(z)`            | eta(z) >= 0, 0 < z < 1                                                                   |
/// | `k.first_moment(z)`   | int_0^z r eta(r) dr, nondecreasing, 0 at z = 0 and 1 at z = 1                            |
/// | `k.origin_exponent()` | a < 2 such that z^a eta(z) is smooth up to z = 0                                         |
/// | `k.regular_part(z)`   | z^a eta(z), 0 <= z <= 1                                                                  |
/// | `k.breakpoint()`      | the interior point where eta is not smooth, or 1 if there is none                        |
///
/// Arguments are distances in units of the horizon, 0 <= z <= 1.
template <class K>
concept Kernel = requires(const K k, double z) {
  { k.eta(z) } -> std::same_as<double>;
  { k.first_moment(z) } -> std::same_as<double>;
  { k.origin_exponent() } -> std::same_as<double>;
  { k.regular_part(z) } -> std::same_as<double>;
  { k.breakpoint() } -> std::same_as<double>;
};

/// A kernel that Model II can use as well: eta itself is integrable, so that its cell integrals exist (3.3).
///
/// | expression  | meaning                                    |
/// |-------------|--------------------------------------------|
/// | `k.mass(z)` | int_0^z eta(r) dr, nondecreasing           |
template <class K>
concept IntegrableKernel = Kernel<K> && requires(const K k, double z) {
  { k.mass(z) } -> std::same_as<double>;
};

/// eta(z) = 1/z: the singular kernel of section 4.1. Its cell moments are the cell lengths.
struct InverseKernel {
  double eta(double z) const { return 1.0 / z; }
  double first_moment(double z) const { return z; }
  double origin_exponent() const { return 1.0; }
  double regular_part(double) const { return 1.0; }
  double breakpoint() const { return 1.0; }
};

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
  double origin_exponent() const { return alpha_; }
  double regular_part(double) const { return 2.0 - alpha_; }
  double breakpoint() const { return 1.0; }

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
  double origin_exponent() const { return 0.0; }
  double regular_part(double z) const { return eta(z); }
  double breakpoint() const { return 0.5; }
};

}  // namespace acstudy
