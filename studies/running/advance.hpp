#pragma once

/// @file
/// Time loop of one scheme: source, motion and semidiscretization put together.

#include <chrono>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

#include "mms/source.hpp"
#include "solver/line/particles.hpp"
#include "solver/time/implicit.hpp"
#include "solver/time/integrate.hpp"
#include "studies/models/operator.hpp"
#include "studies/models/scheme.hpp"
#include "studies/running/outcome.hpp"
#include "studies/running/run_case.hpp"
#include "studies/running/step_rule.hpp"
#include "studies/running/stopwatch.hpp"
#include "studies/running/watch.hpp"

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

/// A scheme with its source on particles in motion: the system that integrators step, du/dt = R u + f.
template <class Motion>
class LineSchemeInMotion {
 public:
  /// All arguments outlive the system. The scheme knows its rows if the case is solved for or follows them.  @param
  /// result  gets the times and counts of what the scheme does not count
  LineSchemeInMotion(const Case& c, LineScheme& scheme, Source& source, Motion& motion, BoundWatch& watch,
                     CaseResult& result)
      : scheme_(scheme),
        source_(source),
        motion_(motion),
        watch_(watch),
        result_(result),
        particles_(static_cast<std::size_t>(c.N), c.scene->period(), c.delta),
        f_(particles_.size()),
        bound_(c.step.bound),
        watched_(!c.integrator->implicit()),
        lemma_bound_(c.lemma_bound(1.0)) {
    place(0.0);
  }

  /// From u at time t to the unknown, which for some schemes is V u; and back.
  void to_unknown(double t, std::span<double> u) {
    if (scheme_.volumes().empty()) return;
    move(t);
    times_volumes(u);
  }
  void to_solution(double t, std::span<double> unknown) {
    if (scheme_.volumes().empty()) return;
    move(t);
    const std::span<const double> V = scheme_.volumes();
    for (std::size_t j = 0; j < V.size(); ++j) unknown[j] /= V[j];
  }

  void rate(double t, PeriodicArray& u, std::span<double> du) {
    see(t);
    timed(result_.pairs_seconds, [&] { scheme_.rate(u, du); });
    for (std::size_t j = 0; j < du.size(); ++j) du[j] += f_[j];
  }

  /// u <- U with U - scale (R U + f) = u, at time t.
  void solve(double t, double scale, PeriodicArray& u) {
    see(t);
    if (factorized_for_ != scale) {
      scheme_.rows()->matrix(matrix_);
      solver_.factorize(matrix_, scale);
      factorized_for_ = scale;
    }
    for (std::size_t j = 0; j < f_.size(); ++j) u.values()[j] += scale * f_[j];
    solver_.solve(u.values());
  }

  /// The bound of the case's step rule at the particles of time t.
  double bound(double t) {
    move(t);
    return bound_ == StepRule::Bound::rows ? 1.0 / scheme_.rows()->strongest_decay()
                                           : lemma_bound_ * smallest_gap().width;
  }

 private:
  struct Gap {
    double width, place;
  };
  Gap smallest_gap() const {
    const PeriodicArray& x = particles_.x;
    std::ptrdiff_t closest = 0;
    for (std::ptrdiff_t j = 1; j < std::ssize(x); ++j) {
      if (x[j + 1] - x[j] < x[closest + 1] - x[closest]) closest = j;
    }
    return {x[closest + 1] - x[closest], x[closest]};
  }

  void place(double t) {
    std::span<const double> x;
    timed(result_.positions_seconds, [&] { x = motion_.at(t); });
    timed(result_.weights_seconds, [&] {
      particles_.place(x);
      scheme_.place(particles_);
    });
    timed(result_.source_seconds, [&] { source_.place(particles_.x.values()); });
    factorized_for_ = 0.0;
    if (watched_) gap_ = smallest_gap();
  }

  void move(double t) {
    if (!motion_.moved_since(t)) return;
    place(t);
    result_.flow_evaluations += std::ssize(particles_.x);
  }

  void times_volumes(std::span<double> values) const {
    const std::span<const double> V = scheme_.volumes();
    for (std::size_t j = 0; j < V.size(); ++j) values[j] *= V[j];
  }

  /// Particles, source and bound as a stage at time t sees them.
  void see(double t) {
    move(t);
    timed(result_.source_seconds, [&] { source_.evaluate(t, f_); });
    times_volumes(f_);
    if (watched_) watch_.stage(lemma_bound_ * gap_.width, gap_.place);
  }

  LineScheme& scheme_;
  Source& source_;
  Motion& motion_;
  BoundWatch& watch_;
  CaseResult& result_;
  Particles particles_;
  std::vector<double> f_;
  StepRule::Bound bound_;
  bool watched_;        ///< implicit steps are bounded by no lemma
  double lemma_bound_;  ///< for a smallest gap of 1
  Gap gap_ = {};
  RateMatrix matrix_;
  ImplicitSolver solver_;
  double factorized_for_ = 0.0;  ///< the scale; 0: for none
};

/// Integrates from the exact initial values to T and measures the error; one repeat.
template <class Motion>
CaseResult advance(const Case& c, LineScheme& scheme, Source& source, const std::atomic<bool>& stop) {
  const Scene& scene = *c.scene;
  const auto count = static_cast<std::size_t>(c.N);
  CaseResult result;
  Motion motion(scene, start_positions(c.start, count, scene.period()));
  PeriodicArray u(count);
  scene.initial(motion.at(0.0), u.values());
  GrowthWatch growth(u.values());
  const double solution_at_first = max_norm({u.values().begin(), u.values().end()});
  double t = 0.0;
  bool interrupted = false;

  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  BoundWatch watch;
  const auto keep_going = [&](std::int64_t n, const TimeStep& step) {
    watch.step(n, step);
    count_step(result, n, step);
    t = step.end;
    const auto exact_size = [&] { return scene.solution_size(motion.at(t), t); };
    const bool ended = t >= scene.T();
    const bool goes_on = growth.makes_sense(n, t, u.values(), exact_size) &&
                         (ended || !std::isfinite(c.limit) || !gave_out(result, c, elapsed(), t));
    interrupted = goes_on && !ended && stop.load(std::memory_order_relaxed);
    return goes_on && !interrupted;
  };

  try {
    LineSchemeInMotion<Motion> system(c, scheme, source, motion, watch, result);
    Stepper stepper(*c.integrator, u.size(), c.step.adaptive());
    step_to_end(
        c, [&](double at) { return system.bound(at); },
        StepActions{[&](const TimeStep& step) {
                      system.to_unknown(step.begin, u.values());
                      stepper(step, u, system);
                      system.to_solution(step.end, u.values());
                    },
                    [&](double tolerance) { return stepper.error(tolerance, u.values()); },
                    [&] {
                      stepper.take_back(u.values());
                      watch.take_back();
                      ++result.rejected;
                    }},
        keep_going);
  } catch (const std::domain_error& error) {
    growth.restore(u.values());
    result.failure = failure_in_step(error, result, t);
  }
  result.against_bound = watch.result();
  result.seconds = elapsed();
  if (interrupted) return result;

  conclude(
      result, c, growth, u.values(), t, solution_at_first, [&](double time) { return motion.at(time); },
      [&](const Points& x) { return widths_on_line(x.line(), scene.period()); });
  result.work = scheme.work();
  result.quadrature_points = source.quadrature_points();
  result.completed = true;
  return result;
}

}  // namespace acstudy
