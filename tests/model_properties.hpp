#pragma once

/// Properties that both models have. A `Model` offers for_each_kernel, for_each_divergence, placed<Divergence>(kernel,
/// x, delta, velocity) and written_out<Divergence>(kernel, x, delta, velocity, u).

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "solver/kernels.hpp"
#include "tests/catch.hpp"
#include "tests/irregular_particles.hpp"
#include "tests/velocities.hpp"

namespace acstudy::test {

inline constexpr double period = 2.0 * std::numbers::pi;
inline constexpr std::size_t N = 41;
inline constexpr double h = period / N;
/// From below every gap to nearly half the period.
inline constexpr double horizons[] = {1e-6 * h, 0.5 * h, h, 2.5 * h, 7.3 * h, 0.49 * period};

inline double largest(const std::vector<double>& values) {
  double value = 0.0;
  for (const double v : values) value = std::fmax(value, std::abs(v));
  return value;
}

template <class Model>
void check_rates_are_those_written_out() {
  const auto u = irregular_values(N, 6);
  const auto v = uneven_velocity();
  for (const unsigned seed : {1u, 2u}) {
    const auto x = irregular_positions(N, period, seed);
    Model::for_each_kernel([&](const std::string& name, auto kernel) {
      for (const double delta : horizons) {
        Model::for_each_divergence([&]<class Divergence>(const std::string& equation, Divergence) {
          INFO(name << ", " << equation << ", delta / h = " << delta / h);
          auto scheme = Model::template placed<Divergence>(kernel, x, delta, v);
          // The quadrature in the test reaches 1e-12.
          CHECK(relative_gap(rates(scheme, u), Model::template written_out<Divergence>(kernel, x, delta, v, u)) <
                2e-11);
        });
      }
    });
  }
}

/// x -> -x, c -> -c, b -> -b
template <class Model>
void check_left_is_like_right() {
  const auto x = irregular_positions(N, period, 7);
  const auto u = irregular_values(N, 8);
  const std::vector<double> u_mirrored(u.rbegin(), u.rend());
  std::vector<double> x_mirrored;
  for (std::size_t j = N; j-- > 0;) x_mirrored.push_back(-x[j]);
  Model::for_each_kernel([&](const std::string& name, auto kernel) {
    for (const double delta : horizons) {
      Model::for_each_divergence([&]<class Divergence>(const std::string& equation, Divergence) {
        INFO(name << ", " << equation << ", delta / h = " << delta / h);
        auto here = Model::template placed<Divergence>(kernel, x, delta, uneven_velocity());
        auto there = Model::template placed<Divergence>(kernel, x_mirrored, delta, reflected(uneven_velocity()));
        auto mirrored = rates(there, u_mirrored);
        CHECK(relative_gap({mirrored.rbegin(), mirrored.rend()}, rates(here, u)) < 1e-13);
        CHECK(relative_gap(mirrored, rates(here, u)) > 1e-3);  // the comparison would notice
      });
    }
  });
}

template <class Model>
void check_origin_and_first_particle_are_free() {
  const auto x = irregular_positions(N, period, 9);
  const auto u = irregular_values(N, 10);
  Model::for_each_divergence([&]<class Divergence>(const std::string& equation, Divergence) {
    const auto placed_at = [&](const std::vector<double>& at, const PointwiseVelocity& v) {
      return Model::template placed<Divergence>(CubicSplineKernel{}, at, 3.3 * h, v);
    };
    auto here = placed_at(x, uneven_velocity());
    const auto rate = rates(here, u);
    for (const double shift : {0.7, -20.0, 100.0 * period}) {
      INFO(equation << ", shift " << shift);
      auto moved = x;
      for (double& value : moved) value += shift;
      auto there = placed_at(moved, translated(uneven_velocity(), shift));
      // A shift by 100 periods costs 628 / h of the digits of a gap.
      CHECK(relative_gap(rates(there, u), rate) < 1e-11);
    }
    for (const std::size_t turn : {1u, 13u, 40u}) {
      INFO(equation << ", first particle " << turn);
      std::vector<double> x_turned, u_turned, expected;
      for (std::size_t j = 0; j < N; ++j) {
        x_turned.push_back(j + turn < N ? x[j + turn] : x[j + turn - N] + period);
        u_turned.push_back(u[(j + turn) % N]);
        expected.push_back(rate[(j + turn) % N]);
      }
      auto there = placed_at(x_turned, uneven_velocity());
      CHECK(relative_gap(rates(there, u_turned), expected) < 1e-13);
    }
  });
}

/// Under constant c: at rest, with the nonlocal divergence in any motion, with the local one not.
template <class Model>
void check_constants_are_kept() {
  const auto x = irregular_positions(N, period, 11);
  const std::vector<double> constant(N, 3.0);
  PointwiseVelocity moving = uneven_velocity();
  moving.c_at = [](double) { return 0.4; };
  Model::for_each_kernel([&](const std::string& name, auto kernel) {
    for (const double delta : horizons) {
      INFO(name << ", delta / h = " << delta / h);
      for (const double c : {1.0, -0.7}) {
        auto standing = Model::template placed<NoDivergence>(kernel, x, delta, constant_velocity(c));
        CHECK(largest(rates(standing, constant)) < 1e-12);
      }
      auto nonlocal = Model::template placed<NonlocalDivergence>(kernel, x, delta, moving);
      CHECK(largest(rates(nonlocal, constant)) < 1e-12);
      auto local = Model::template placed<LocalDivergence>(kernel, x, delta, moving);
      CHECK(largest(rates(local, constant)) > 1e-3);
    }
  });
}

}  // namespace acstudy::test
