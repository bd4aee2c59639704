#pragma once

/// @file
/// Rates by a sweep and by the readable form, on the same particles.

#include <cmath>
#include <numbers>
#include <vector>

#include "solver/line/model1.hpp"
#include "solver/line/model2.hpp"
#include "solver/line/vector/sweeps.hpp"
#include "tests/irregular_particles.hpp"
#include "tests/velocities.hpp"

namespace acstudy::test {

/// Rates of the two divergence forms.
struct BothRates {
  std::vector<double> local, nonlocal;
};

/// What a sweep is given, on particles at `x`, with the arrays behind it.
struct SweptParticles {
  SweptParticles(const std::vector<double>& x, double period, double delta, const PointwiseVelocity& velocity_,
                 unsigned seed)
      : particles(placed(x, period, delta)),
        velocity(velocity_),
        local_u(irregular_values(x.size(), seed)),
        nonlocal_u(irregular_values(x.size(), seed + 1)),
        rates{padded(), padded()} {
    const std::ptrdiff_t reach = particles.windows.widest + 1;
    particles.x.wrap(reach, period);
    const auto field = [&](auto value) {
      PeriodicArray values(x.size());
      for (std::size_t j = 0; j < x.size(); ++j) values[static_cast<std::ptrdiff_t>(j)] = value(j);
      values.wrap(reach);
      return values;
    };
    c_hat = field([&](std::size_t j) { return velocity.c_hat_at(x[j]); });
    c = field([&](std::size_t j) { return velocity.c_at(x[j]); });
    b = field([&](std::size_t j) { return velocity.b_at(x[j]); });
    b_prime = field([&](std::size_t j) { return velocity.b_prime_at(x[j]); });
    u[0] = field([&](std::size_t j) { return local_u[j]; });
    u[1] = field([&](std::size_t j) { return nonlocal_u[j]; });
    for (const int form : {0, 1}) {
      flux[form] =
          field([&](std::size_t j) { return velocity.c_hat_at(x[j]) * (form == 0 ? local_u : nonlocal_u)[j]; });
    }
    const double inside = delta * (1.0 + horizon_tie_tolerance) + 1e-15 * (period + std::abs(x.front()));
    range = {particles.x.at(0), delta, inside, 0, static_cast<std::ptrdiff_t>(x.size())};
  }

  UpwindSweep upwind(SweepKernel::Form kernel) {
    return {.kernel = {kernel},
            .c_hat = c_hat.at(0),
            .b_prime = b_prime.at(0),
            .c = c.at(0),
            .b = b.at(0),
            .local = {u[0].at(0), flux[0].at(0), rates.local.data()},
            .nonlocal = {u[1].at(0), flux[1].at(0), rates.nonlocal.data()}};
  }

  /// For velocities of the modes 1 and 2, or of 1, 2 and 3.
  SymmetricSweep symmetric(double mu, int modes) {
    SymmetricSweep sweep{.kernel = {SweepKernel::Form::cubic_spline},
                         .mu = mu,
                         .x = particles.x.at(0),
                         .panels = {},
                         .half_cosine = {},
                         .half_sine = {},
                         .c = series([&](double x) { return velocity.c_at(x); }, modes),
                         .b = series([&](double x) { return velocity.b_at(x); }, modes),
                         .b_prime = b_prime.at(0),
                         .local = {u[0].at(0), nullptr, rates.local.data()},
                         .nonlocal = {u[1].at(0), nullptr, rates.nonlocal.data()}};
    for (int n = 0; n < most_modes; ++n) {
      const auto mode = [&](auto function) {
        PeriodicArray values(particles.size());
        for (std::ptrdiff_t j = 0; j < std::ssize(values); ++j) values[j] = function(0.5 * (n + 1) * particles.x[j]);
        const std::ptrdiff_t reach = particles.windows.widest + 1;
        n % 2 == 1 ? values.wrap(reach) : values.wrap_alternating(reach);
        return values;
      };
      half_cosine[n] = mode([](double x) { return std::cos(x); });
      half_sine[n] = mode([](double x) { return std::sin(x); });
      sweep.half_cosine[n] = half_cosine[n].at(0);
      sweep.half_sine[n] = half_sine[n].at(0);
    }
    return sweep;
  }

  Particles particles;
  PointwiseVelocity velocity;
  std::vector<double> local_u, nonlocal_u;
  PeriodicArray c_hat, c, b, b_prime, u[2], flux[2], half_cosine[most_modes], half_sine[most_modes];
  SweepRange range;
  BothRates rates;  ///< of the sweep; NaN where it writes none

 private:
  /// A field of period 2 pi that has no other modes.
  template <class Field>
  static SweepField series(Field field, int modes) {
    constexpr int samples = 16;
    SweepField result;
    result.modes = modes;
    for (int n = 0; n < modes; ++n) result.mode[n] = n;
    for (int i = 0; i < samples; ++i) {
      const double x = 2.0 * std::numbers::pi * i / samples, value = field(x) / samples;
      result.constant += value;
      for (int n = 0; n < modes; ++n) {
        result.cosine[n] += 2.0 * value * std::cos((n + 1) * x);
        result.sine[n] += 2.0 * value * std::sin((n + 1) * x);
      }
    }
    return result;
  }
  std::vector<double> padded() const { return std::vector<double>(particles.size() + 8, NAN); }
};

/// The readable form of Model I.
template <Kernel K>
BothRates readable_upwind(const SweptParticles& swept, K kernel) {
  ModelI<K, LocalDivergence> local(kernel);
  ModelI<K, NonlocalDivergence> nonlocal(kernel);
  local.place(swept.particles, swept.velocity);
  nonlocal.place(swept.particles, swept.velocity);
  return {test::rates(local, swept.local_u), test::rates(nonlocal, swept.nonlocal_u)};
}

/// The readable form of Model II with the cubic spline.
inline BothRates readable_symmetric(const SweptParticles& swept, double mu) {
  ModelII<CubicSplineKernel, LocalDivergence> local(CubicSplineKernel{}, mu);
  ModelII<CubicSplineKernel, NonlocalDivergence> nonlocal(CubicSplineKernel{}, mu);
  local.place(swept.particles, swept.velocity);
  nonlocal.place(swept.particles, swept.velocity);
  return {test::rates(local, swept.local_u), test::rates(nonlocal, swept.nonlocal_u)};
}

}  // namespace acstudy::test
