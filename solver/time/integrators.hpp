#pragma once

/// @file
/// Time integrators and the steps they take: explicit strong-stability-preserving Runge-Kutta schemes in Shu-Osher
/// form, and L-stable diagonally implicit ones for stiff scenes.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "solver/particles.hpp"

namespace acstudy {

/// One explicit stage: u <- (1 - weight) u^n + weight (u + dt rate(t^n + time dt, u)).
struct Stage {
  double weight;
  double time;
};

/// One implicit stage: U with U - diagonal dt rate(t^n + time dt, U) = u^n + previous dt k_1, where k_1 is the rate
/// that the first stage has found.
struct ImplicitStage {
  double diagonal;
  double time;
  double previous;
};

/// A scheme is its table: explicit stages or implicit ones. Convex weights make every explicit stage a convex
/// combination of forward Euler steps, so the maximum-norm bounds of Lemmas 2.4 and 3.3 carry over at the same time
/// step. The last implicit stage is u^{n+1} (stiffly accurate).
struct Integrator {
  std::string_view name;
  int order;
  std::span<const Stage> stages = {};
  std::span<const ImplicitStage> implicit_stages = {};

  bool implicit() const { return !implicit_stages.empty(); }
  std::size_t stage_count() const { return stages.size() + implicit_stages.size(); }
};

inline constexpr Stage forward_euler_stages[] = {{1.0, 0.0}};
inline constexpr Stage ssprk2_stages[] = {{1.0, 0.0}, {0.5, 1.0}};
inline constexpr Stage ssprk3_stages[] = {{1.0, 0.0}, {0.25, 1.0}, {2.0 / 3.0, 0.5}};
inline constexpr ImplicitStage backward_euler_stages[] = {{1.0, 1.0, 0.0}};
/// 1 - 1/sqrt(2), with which two stages of one diagonal are of second order and L-stable.
inline constexpr double sdirk2_gamma = 0.29289321881345247560;
inline constexpr ImplicitStage sdirk2_stages[] = {{sdirk2_gamma, sdirk2_gamma, 0.0},
                                                  {sdirk2_gamma, 1.0, 1.0 - sdirk2_gamma}};

inline constexpr Integrator integrators[] = {
    {"forward-euler", 1, forward_euler_stages},       {"ssprk2", 2, ssprk2_stages},     {"ssprk3", 3, ssprk3_stages},
    {"backward-euler", 1, {}, backward_euler_stages}, {"sdirk2", 2, {}, sdirk2_stages},
};

inline constexpr const Integrator& forward_euler = integrators[0];

/// Equal steps: the fewest with dt <= bound (T an exact multiple of the bound up to round-off counts as such).
inline std::int64_t steps_for(double T, double bound) {
  return static_cast<std::int64_t>(std::ceil(T / bound * (1.0 - 1e-12)));
}

/// From t^n to t^{n+1}. Steps of one length have it to the bit, though the difference of their times is rounded.
struct TimeStep {
  double begin, end, dt;
  /// The last stage of a step and the first of the next see the same time, to the bit.
  double at(double fraction) const { return fraction == 1.0 ? end : begin + fraction * dt; }
};

/// T in `count` equal steps, t^n = n T / count.  T = 0 takes none.
class EqualSteps {
 public:
  EqualSteps(double T, std::int64_t count)
      : T_(T), dt_(count == 0 ? 0.0 : T / static_cast<double>(count)), count_(count) {}
  std::optional<TimeStep> next() {
    if (n_ == count_) return std::nullopt;
    const double begin = at(n_);
    return TimeStep{begin, at(++n_), dt_};
  }

 private:
  double at(std::int64_t n) const { return n == count_ ? T_ : static_cast<double>(n) * dt_; }
  double T_, dt_;
  std::int64_t count_, n_ = 0;
};

/// Steps to T that a bound limits anew each time: the rest of T in the fewest equal steps within the bound, of which
/// one is taken. So none is much smaller than the bound, the last one ends at T, and while the bound stays the steps
/// are equal.
template <class Bound>
class BoundedSteps {
 public:
  /// @param bound  bound(t) > 0: the largest step from t on
  BoundedSteps(double T, Bound bound) : T_(T), bound_(std::move(bound)) {}
  std::optional<TimeStep> next() {
    if (t_ == T_) return std::nullopt;
    const double begin = t_;
    if (const double limit = bound_(t_); limit != limit_) {
      limit_ = limit;
      left_ = std::max(1.0, std::ceil((T_ - t_) / limit * (1.0 - 1e-12)));
      dt_ = (T_ - t_) / left_;
    }
    left_ -= 1.0;
    t_ = left_ == 0.0 ? T_ : t_ + dt_;
    if (t_ == begin) throw std::domain_error("the time step has become too small to advance time");
    return TimeStep{begin, t_, dt_};
  }

 private:
  double T_;
  Bound bound_;
  double t_ = 0.0, limit_ = 0.0;
  double dt_ = 0.0, left_ = 0.0;  ///< the equal steps to T at this limit
};

/// A system that is only ever stepped explicitly: no more than its rate.
template <class Rate>
struct ExplicitSystem {
  Rate rate;
};

/// Advances u step by step.
///
/// @param steps       `next()` gives a TimeStep until there is none
/// @param system      `rate(t, u, du)` fills du = du/dt of all particles; it may wrap the ghosts of u. Implicit
///                    integrators need `solve(t, scale, u)`, which replaces u by the U with U - scale rate(t, U) = u
/// @param keep_going  called with n and the step after each step n = 1, 2, ...; false ends the run early
/// @return            the number of steps done
template <class Steps, class System, class Observer>
std::int64_t integrate(const Integrator& integrator, PeriodicArray& u, Steps&& steps, System&& system,
                       Observer&& keep_going) {
  std::vector<double> u_n, du(u.size());
  if (integrator.stage_count() > 1) u_n.resize(u.size());
  const auto values = u.values();
  std::int64_t n = 0;
  while (const std::optional<TimeStep> step = steps.next()) {
    const double dt = step->dt;
    if (!u_n.empty()) std::copy(values.begin(), values.end(), u_n.begin());
    for (const Stage& stage : integrator.stages) {
      system.rate(step->at(stage.time), u, std::span<double>(du));
      if (stage.weight == 1.0) {
        for (std::size_t j = 0; j < u.size(); ++j) values[j] += dt * du[j];
      } else {
        for (std::size_t j = 0; j < u.size(); ++j) {
          values[j] = (1.0 - stage.weight) * u_n[j] + stage.weight * (values[j] + dt * du[j]);
        }
      }
    }
    if constexpr (requires { system.solve(0.0, 0.0, u); }) {
      for (const ImplicitStage& stage : integrator.implicit_stages) {
        if (stage.previous != 0.0) {
          for (std::size_t j = 0; j < u.size(); ++j) values[j] = u_n[j] + stage.previous * dt * du[j];
        }
        const double scale = stage.diagonal * dt;
        system.solve(step->at(stage.time), scale, u);
        if (&stage == &integrator.implicit_stages.front() && !u_n.empty()) {
          for (std::size_t j = 0; j < u.size(); ++j) du[j] = (values[j] - u_n[j]) / scale;
        }
      }
    } else if (integrator.implicit()) {
      throw std::logic_error("an implicit integrator for a system that cannot be solved");
    }
    ++n;
    if (!keep_going(n, *step)) break;
  }
  return n;
}

}  // namespace acstudy
