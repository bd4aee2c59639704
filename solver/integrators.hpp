#pragma once

/// @file
/// Explicit strong-stability-preserving Runge-Kutta schemes in Shu-Osher form.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "solver/particles.hpp"

namespace acstudy {

/// One stage: u <- (1 - weight) u^n + weight (u + dt rate(t^n + time dt, u)).
struct Stage {
  double weight;
  double time;
};

/// A scheme is its table. Convex weights make every stage a convex combination of forward Euler steps, so the
/// maximum-norm bounds of Lemmas 2.4 and 3.3 carry over at the same time step.
struct Integrator {
  std::string_view name;
  int order;
  std::span<const Stage> stages;
};

inline constexpr Stage forward_euler_stages[] = {{1.0, 0.0}};
inline constexpr Stage ssprk2_stages[] = {{1.0, 0.0}, {0.5, 1.0}};
inline constexpr Stage ssprk3_stages[] = {{1.0, 0.0}, {0.25, 1.0}, {2.0 / 3.0, 0.5}};

inline constexpr Integrator integrators[] = {
    {"forward-euler", 1, forward_euler_stages},
    {"ssprk2", 2, ssprk2_stages},
    {"ssprk3", 3, ssprk3_stages},
};

/// Equal steps: the fewest with dt <= bound (T an exact multiple of the bound up to round-off counts as such).
inline std::int64_t steps_for(double T, double bound) {
  return static_cast<std::int64_t>(std::ceil(T / bound * (1.0 - 1e-12)));
}

/// Advances u from time 0 to T in `steps` equal steps.
///
/// @param rate       rate(t, u, du) fills du = du/dt of all particles; it may wrap the ghosts of u
/// @param keep_going called with n after each step n = 1 .. steps; false ends the run early
/// @return           the number of steps done
template <class Rate, class Observer>
std::int64_t integrate(const Integrator& integrator, PeriodicArray& u, double T, std::int64_t steps, Rate&& rate,
                       Observer&& keep_going) {
  const double dt = T / static_cast<double>(steps);
  std::vector<double> u_n(u.size()), du(u.size());
  const auto values = u.values();
  for (std::int64_t n = 0; n < steps; ++n) {
    if (integrator.stages.size() > 1) std::copy(values.begin(), values.end(), u_n.begin());
    for (const Stage& stage : integrator.stages) {
      rate((static_cast<double>(n) + stage.time) * dt, u, std::span<double>(du));
      if (stage.weight == 1.0) {
        for (std::size_t j = 0; j < u.size(); ++j) values[j] += dt * du[j];
      } else {
        for (std::size_t j = 0; j < u.size(); ++j) {
          values[j] = (1.0 - stage.weight) * u_n[j] + stage.weight * (values[j] + dt * du[j]);
        }
      }
    }
    if (!keep_going(n + 1)) return n + 1;
  }
  return steps;
}

}  // namespace acstudy
