#pragma once

/// @file
/// One step of an integrator, and all of them: stages of any table on any state.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "solver/time/adaptive.hpp"
#include "solver/time/integrators.hpp"
#include "solver/time/steps.hpp"

namespace acstudy {

/// The explicit part of a stage at some entries of the state: a u^n + w (base + step F), F being the newest rate. What
/// else the table asks for is summed up in `base` before.
struct StageSum {
  double a;
  const double* u_n;
  double w;
  const double* base;
  double step;

  /// At entry j, where the newest rate is `rate`.
  double operator()(std::ptrdiff_t j, double rate) const { return a * u_n[j] + w * (base[j] + step * rate); }
};

/// What stages need of earlier ones of the step, but for u^n. For two-register schemes that is nothing.
class StageRegisters {
 public:
  /// @param count  entries of the state
  StageRegisters(const Integrator& integrator, std::size_t count)
      : integrator_(integrator), states_(integrator.stage_count()), rates_(integrator.stage_count()) {
    for (std::size_t k = 0; k < integrator.stage_count(); ++k) {
      if (k > 0 && integrator.asks_for_state(k, k + 1)) states_[k].resize(count);
      if (integrator.asks_for_rate(k, k + 1)) rates_[k].resize(count);
      if (!is_euler(k + 1)) rest_.resize(count);
    }
  }

  /// The sum of stage i for entries `begin` on. Its newest rate may be asked for by later stages: then keep() it.
  /// @param u_n, u  U_0 and U_{i-1} from entry `begin` on
  StageSum sum(std::size_t i, double dt, const double* u_n, const double* u, std::ptrdiff_t begin,
               std::ptrdiff_t count) {
    const Stage& stage = integrator_.stage(i);
    const std::size_t newest = i - 1;
    if (!states_[newest].empty()) std::copy_n(u, count, states_[newest].begin() + begin);
    if (is_euler(i)) {
      const double w = stage.alpha[newest];
      return {newest == 0 ? 0.0 : stage.alpha[0], u_n, w, u, dt * (stage.beta[newest] / w)};
    }
    double* const rest = rest_.data() + begin;
    for (std::ptrdiff_t j = 0; j < count; ++j) rest[j] = stage.alpha[0] * u_n[j];
    const auto add = [&](double factor, const double* values) {
      for (std::ptrdiff_t j = 0; j < count && factor != 0.0; ++j) rest[j] += factor * values[j];
    };
    for (std::size_t k = 0; k < newest; ++k) {
      if (k > 0) add(stage.alpha[k], states_[k].data() + begin);
      add(stage.beta[k] * dt, rates_[k].data() + begin);
    }
    if (newest > 0) add(stage.alpha[newest], u);
    return {0.0, u_n, 1.0, rest, dt * stage.beta[newest]};
  }

  /// Where F_k of all entries has to be kept; empty if no stage asks for it when a newer one is there.
  std::span<double> rate(std::size_t k) { return rates_[k]; }

 private:
  /// True if the stage is a forward Euler step from the stage before, averaged with u^n.
  bool is_euler(std::size_t i) const {
    const Stage& stage = integrator_.stage(i);
    const std::size_t newest = i - 1;
    const bool others =
        std::any_of(stage.beta.begin(), stage.beta.begin() + newest, [](double b) { return b != 0.0; }) ||
        std::any_of(stage.alpha.begin() + 1, stage.alpha.begin() + std::max<std::size_t>(newest, 1),
                    [](double a) { return a != 0.0; });
    return stage.alpha[newest] != 0.0 && stage.beta[newest] != 0.0 && !others;
  }

  const Integrator& integrator_;
  std::vector<std::vector<double>> states_, rates_;  ///< U_k and F_k, empty where they are not needed
  std::vector<double> rest_;
};

/// The entries of a state: those of a span, or of what has `values()`.
template <class State>
std::span<double> entries_of(State& u) {
  if constexpr (requires { u.values(); }) {
    return u.values();
  } else {
    return u;
  }
}

/// A system that is only ever stepped explicitly: no more than its rate.
template <class Rate>
struct ExplicitSystem {
  Rate rate;
};

/// Takes the steps of an integrator.
///
/// A system has `rate(t, u, du)`, which fills du, shape [entries], with du/dt and may change what `u` has beside its
/// entries, such as ghosts. Implicit integrators need `solve(t, scale, u)`, which replaces u by the U with
/// U - scale rate(t, U) = u.
class Stepper {
 public:
  /// @param count      entries of the state
  /// @param estimates  the error of every step is estimated  @pre integrator.estimates()
  Stepper(const Integrator& integrator, std::size_t count, bool estimates = false)
      : integrator_(integrator),
        registers_(integrator, count),
        u_n_(integrator.stage_count() > 1 ? count : 0),
        du_(count),
        right_(integrator.implicit() ? count : 0),
        error_(estimates ? count : 0) {}

  /// @throws std::logic_error if the integrator is implicit and the system cannot be solved
  template <class State, class System>
  void operator()(const TimeStep& step, State& u, System& system) {
    const std::span<double> values = entries_of(u);
    std::copy_n(values.begin(), u_n_.size(), u_n_.begin());
    std::fill(error_.begin(), error_.end(), 0.0);
    for (std::size_t i = 1; i <= integrator_.stage_count(); ++i) {
      const std::size_t newest = i - 1;
      if (integrator_.diagonal(newest) == 0.0 && integrator_.asks_for_rate(newest, newest)) {
        system.rate(step.at(integrator_.c(newest)), u, std::span<double>(du_));
      }
      estimate(newest, step.dt);
      const auto kept = registers_.rate(newest);
      std::copy_n(du_.begin(), kept.size(), kept.begin());
      const double* const u_n = u_n_.empty() ? values.data() : u_n_.data();
      const StageSum sum = registers_.sum(i, step.dt, u_n, values.data(), 0, std::ssize(values));
      if (sum.step != 0.0) {
        for (std::ptrdiff_t j = 0; j < std::ssize(values); ++j) values[j] = sum(j, du_[j]);
      } else {
        std::copy_n(sum.base, values.size(), values.begin());
      }
      if (integrator_.diagonal(i) != 0.0) solve(i, step, u, system);
    }
    estimate(integrator_.stage_count(), step.dt);
  }

  /// The estimated error of the step that led to u over what is tolerated, see error_over().
  double error(double tolerance, std::span<const double> u) const {
    return error_over(tolerance, largest_of(error_), largest_of(u_n_), largest_of(u));
  }

  /// u as it was before the step.  @pre the integrator has several stages
  void take_back(std::span<double> u) const { std::copy(u_n_.begin(), u_n_.end(), u.begin()); }

 private:
  /// Adds what F_k, which is in `du_`, has in the estimate.
  void estimate(std::size_t k, double dt) {
    const double d = dt * integrator_.estimate[k];
    for (std::size_t j = 0; j < error_.size() && d != 0.0; ++j) error_[j] += d * du_[j];
  }

  template <class State, class System>
  void solve(std::size_t i, const TimeStep& step, State& u, System& system) {
    if constexpr (requires { system.solve(0.0, 0.0, u); }) {
      const std::span<double> values = entries_of(u);
      const double scale = integrator_.diagonal(i) * step.dt;
      std::copy(values.begin(), values.end(), right_.begin());
      system.solve(step.at(integrator_.c(i)), scale, u);
      for (std::size_t j = 0; j < values.size(); ++j) du_[j] = (values[j] - right_[j]) / scale;
    } else {
      throw std::logic_error("an implicit integrator for a system that cannot be solved");
    }
  }

  const Integrator& integrator_;
  StageRegisters registers_;
  std::vector<double> u_n_, du_;
  std::vector<double> right_;  ///< of an implicit stage
  std::vector<double> error_;  ///< estimated; empty where none is
};

/// Advances a state step by step; see each_step() and Stepper.
/// @return the number of steps done
template <class Steps, class State, class System, class GoesOn>
std::int64_t integrate(const Integrator& integrator, State& u, Steps&& steps, System&& system, GoesOn&& goes_on) {
  Stepper stepper(integrator, entries_of(u).size());
  return each_step(
      steps, [&](const TimeStep& step) { stepper(step, u, system); }, goes_on);
}

}  // namespace acstudy
