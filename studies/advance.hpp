#pragma once

/// @file
/// Time loop of one scheme: source, motion and semidiscretization put together.

#include <chrono>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

#include "mms/source.hpp"
#include "solver/integrators.hpp"
#include "solver/particles.hpp"
#include "studies/run_case.hpp"
#include "studies/scheme.hpp"

namespace acstudy {

/// Particles that stand still: placed once.
class StandingParticles {
 public:
  StandingParticles(const Scene&, std::vector<double> start) : x_(std::move(start)) {}
  bool moved_since(double) const { return false; }
  std::span<const double> at(double) const { return x_; }

 private:
  std::vector<double> x_;
};

/// Particles that follow the scene's flow.
class MovingParticles {
 public:
  MovingParticles(const Scene& scene, std::vector<double> start) : trajectories_(scene, std::move(start)) {}
  bool moved_since(double t) {
    const bool moved = t != placed_at_;
    placed_at_ = t;
    return moved;
  }
  std::span<const double> at(double t) { return trajectories_.at(t); }

 private:
  Trajectories trajectories_;
  double placed_at_ = 0.0;
};

/// Integrates from the exact initial values to T and measures the error; one repeat.
template <class Motion>
CaseResult advance(const Case& c, Scheme& scheme, Source& source, const std::atomic<bool>& stop) {
  using Clock = std::chrono::steady_clock;
  const auto seconds_since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  const Scene& scene = *c.scene;
  const auto count = static_cast<std::size_t>(c.N);
  CaseResult result;

  Particles particles(count, scene.period(), c.delta);
  Motion motion(scene, uniform_positions(count, scene.period()));
  PeriodicArray u(count);
  scene.u(motion.at(0.0), 0.0, u.values());
  std::vector<double> f(count);

  const auto place = [&](double t) {
    particles.place(motion.at(t));
    scheme.place(particles);
    const auto start = Clock::now();
    source.place(particles.x.values());
    result.source_seconds += seconds_since(start);
  };
  const auto rate = [&](double t, PeriodicArray& values, std::span<double> du) {
    if (motion.moved_since(t)) {
      place(t);
      result.flow_evaluations += c.N;
    }
    const auto start = Clock::now();
    source.evaluate(t, f);
    result.source_seconds += seconds_since(start);
    scheme.rate(values, du);
    for (std::size_t j = 0; j < count; ++j) du[j] += f[j];
  };
  const auto keep_going = [&](std::int64_t n, TimeStep) {
    constexpr std::int64_t between_checks = 64;
    if (n % between_checks == 0) {
      double sum = 0.0;
      for (const double value : u.values()) sum += std::abs(value);
      if (!std::isfinite(sum)) return false;
    }
    return !stop.load(std::memory_order_relaxed);
  };

  const auto start = Clock::now();
  std::int64_t done = 0;
  try {
    place(0.0);
    done = integrate(*c.integrator, u, EqualSteps(scene.T(), c.steps), ExplicitSystem{rate}, keep_going);
  } catch (const std::domain_error& error) {
    result.failure = error.what();
  }
  result.seconds = seconds_since(start);
  if (stop.load(std::memory_order_relaxed)) return result;
  if (done < c.steps && result.failure.empty()) {
    result.blow_up = "the solution is no longer finite after step " + std::to_string(done);
  }

  const auto x = motion.at(scene.T());
  result.x.assign(x.begin(), x.end());
  result.u.assign(u.values().begin(), u.values().end());
  result.u_exact.resize(count);
  scene.u(x, scene.T(), result.u_exact);
  double l1 = 0.0, l2 = 0.0;
  for (std::size_t j = 0; j < count; ++j) {
    const double right = j + 1 < count ? x[j + 1] : x[0] + scene.period();
    const double left = j > 0 ? x[j - 1] : x[count - 1] - scene.period();
    const double error = std::abs(result.u[j] - result.u_exact[j]), width = 0.5 * (right - left);
    // Once NaN, it stays: no comparison with a NaN is true.
    if (std::isnan(error) || error > result.error_linf) result.error_linf = error;
    l1 += width * error;
    l2 = std::hypot(l2, std::sqrt(width) * error);  // a square of an error may overflow
  }
  result.error_l1 = l1 / scene.period();
  result.error_l2 = l2 / std::sqrt(scene.period());
  if (!std::isfinite(result.error_linf) && result.failure.empty() && result.blow_up.empty()) {
    result.blow_up = "the solution is not finite at T";
  }
  if (!result.failure.empty() || !result.blow_up.empty()) {
    result.error_linf = result.error_l1 = result.error_l2 = std::numeric_limits<double>::quiet_NaN();
  }
  result.work = scheme.work();
  result.quadrature_points = source.quadrature_points();
  result.completed = true;
  return result;
}

}  // namespace acstudy
