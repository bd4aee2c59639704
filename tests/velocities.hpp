#pragma once

/// @file
/// Velocity fields given point by point; models ParticleVelocity.

#include <cmath>
#include <cstddef>
#include <functional>
#include <span>

#include "solver/velocity.hpp"

namespace acstudy::test {

struct PointwiseVelocity {
  std::function<double(double)> c_at;
  std::function<double(double)> b_at = [](double) { return 0.0; };
  std::function<double(double)> b_prime_at = [](double) { return 0.0; };

  void c(std::span<const double> x, std::span<double> out) const { fill(c_at, x, out); }
  void b(std::span<const double> x, std::span<double> out) const { fill(b_at, x, out); }
  void b_prime(std::span<const double> x, std::span<double> out) const { fill(b_prime_at, x, out); }
  double c_hat_at(double x) const { return c_at(x) - b_at(x); }

 private:
  static void fill(const std::function<double(double)>& field, std::span<const double> x, std::span<double> out) {
    for (std::size_t i = 0; i < x.size(); ++i) out[i] = field(x[i]);
  }
};
static_assert(ParticleVelocity<PointwiseVelocity>);

/// c, b and b' of period 2 pi, without symmetry; c - b changes sign.
inline PointwiseVelocity uneven_velocity() {
  return {[](double x) { return 0.2 + std::cos(2.0 * x) / 3.0 + 0.1 * std::sin(x); },
          [](double x) { return std::sin(x + 0.4); }, [](double x) { return std::cos(x + 0.4); }};
}

/// The same fields after the reflection x -> -x, which turns every velocity around.
inline PointwiseVelocity reflected(const PointwiseVelocity& v) {
  return {[v](double x) { return -v.c_at(-x); }, [v](double x) { return -v.b_at(-x); },
          [v](double x) { return v.b_prime_at(-x); }};
}

/// The same fields moved to the right by `shift`.
inline PointwiseVelocity translated(const PointwiseVelocity& v, double shift) {
  return {[=](double x) { return v.c_at(x - shift); }, [=](double x) { return v.b_at(x - shift); },
          [=](double x) { return v.b_prime_at(x - shift); }};
}

inline PointwiseVelocity constant_velocity(double c) {
  return {[=](double) { return c; }};
}

}  // namespace acstudy::test
