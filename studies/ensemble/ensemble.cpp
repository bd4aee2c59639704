#include "studies/ensemble/ensemble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "mms/source_series.hpp"
#include "solver/integrators.hpp"
#include "solver/vector/clones.hpp"
#include "studies/ensemble/shared_particles.hpp"
#include "studies/ensemble/sweep_group.hpp"
#include "studies/operator.hpp"
#include "studies/outcome.hpp"
#include "studies/scheme.hpp"
#include "studies/stopwatch.hpp"
#include "studies/watch.hpp"

namespace acstudy {

namespace {

/// How far midpoints are from the middle of a vector of particles, at the start or at T.
double panel_reach(const Case& c) {
  std::vector<double> x = start_positions(c.start, static_cast<std::size_t>(c.N), c.scene->period());
  const double at_start = gaps(x, c.scene->period()).largest;
  Trajectories trajectories(*c.scene, x);
  const auto at_end = trajectories.at(c.scene->T());
  const double largest = std::max(at_start, gaps({at_end.begin(), at_end.end()}, c.scene->period()).largest);
  return midpoint_reach(c.delta, largest);
}

}  // namespace

bool runs_in_vector_form(const Case& c) {
  if (c.readable) return false;
  if (c.integrator->implicit() || !c.scheme.control.empty() || c.step.bound == StepRule::Bound::rows) return false;
  if (c.scene->standing() || c.scheme.model == 1) return true;
  return c.scheme.model == 2 &&
         (midpoint_modes(VelocitySeries(*c.scene)) || VelocityPanels::find(*c.scene, panel_reach(c)));
}

std::string ensemble_key(const Case& c) {
  const SceneText& text = c.scene->text();
  const std::string bound =
      c.step.bound == StepRule::Bound::none ? "" : fmt::format("|{:.17g}", c.step.safety * c.lemma_bound(1.0));
  return fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}{}|{}{:.17g}", text.period, text.T, text.c, text.b.value_or(""), text.u,
                     text.flow.value_or(""), c.integrator->name, c.N, c.steps, bound, c.start.label(),
                     c.start.smallest_gap);
}

std::string sweep_key(const Case& c) {
  return fmt::format("{}|{}|{:.17g}|{:.17g}", c.scheme.model, c.scheme.kernel.label(), c.delta, c.mu);
}

namespace {

/// u <- (1 - weight) u^n + weight (u + dt (rate + f))
ACSTUDY_VECTOR_CLONES void apply_stage(double weight, double dt, const double* u_n, const double* rate, const double* f,
                                       double* u, std::ptrdiff_t begin, std::ptrdiff_t end) {
  if (weight == 1.0) {
    for (std::ptrdiff_t j = begin; j < end; ++j) u[j] += dt * (rate[j] + f[j]);
  } else {
    for (std::ptrdiff_t j = begin; j < end; ++j) {
      u[j] = (1.0 - weight) * u_n[j] + weight * (u[j] + dt * (rate[j] + f[j]));
    }
  }
}

/// A manufactured source at all particles, by its series if it has one.
class ParticleSource {
 public:
  ParticleSource(const Scene& scene, const SourceSeries::MakeSource& make, bool sided, bool may_be_series,
                 std::size_t count)
      : f_(count), scratch_(sided ? count : 0) {
    // More samples than particles would be no saving.
    if (may_be_series) series_ = SourceSeries::find(scene, make, sided, std::min<std::size_t>(count / 2, 96));
    if (!series_) direct_ = make(Look::upwind);
  }
  bool is_series() const { return series_.has_value(); }
  void evaluate(double t, const SharedParticles& particles, Team& team) {
    if (!series_) {
      if (placed_ != particles.times_moved()) direct_->place(particles.x.values());
      placed_ = particles.times_moved();
      direct_->evaluate(t, f_);
      return;
    }
    series_->at(t);
    const HalfPhases phases = particles.phases();
    team.each(std::ssize(f_), 64, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      const auto part = [&](auto& values) { return std::span(values).subspan(begin, end - begin); };
      const auto c_hat =
          series_->sided() ? particles.c_hat.values().subspan(begin, end - begin) : std::span<const double>();
      series_->evaluate({part(phases.cosine), part(phases.sine)}, c_hat, part(f_),
                        series_->sided() ? part(scratch_) : std::span<double>());
    });
  }
  const std::vector<double>& f() const { return f_; }
  std::int64_t quadrature_points() const {
    return series_ ? series_->quadrature_points() : direct_->quadrature_points();
  }

 private:
  std::optional<SourceSeries> series_;
  std::unique_ptr<Source> direct_;
  std::int64_t placed_ = 0;  ///< the move of the particles after which `direct_` was placed
  std::vector<double> f_, scratch_;
};

/// A case on its way.
struct Member {
  Member(const Case& its_case, std::size_t count)
      : c(its_case),
        values{PeriodicArray(count),
               PeriodicArray(its_case.scheme.model == 1 && !its_case.scene->standing() ? count : 0),
               std::vector<double>(count + 16)} {}

  const Case& c;
  CaseResult result;
  SweptValues values;
  std::vector<double> u_n;  ///< at the start of the step, where there are several stages
  SweepGroup* group = nullptr;
  ParticleSource* source = nullptr;
  std::optional<ParticleSource> own_source;
  std::optional<GrowthWatch> growth;
  BoundWatch bound;
  double lemma_bound = 0.0;  ///< for a smallest gap of 1
  double solution_at_first = 0.0;
  double t = 0.0;
  bool running = true;
};

class Ensemble {
 public:
  Ensemble(std::span<const Case* const> cases, int threads, const std::atomic<bool>& stop)
      : stop_(stop), team_(threads), scene_(*cases.front()->scene), first_(*cases.front()) {
    timed(setup_seconds_, [&] { set_up(cases); });
  }

  std::vector<CaseResult> run() {
    double seconds = 0.0;
    timed(seconds, [&] {
      try {
        if (first_.step.bound == StepRule::Bound::none) {
          go(EqualSteps(scene_.T(), first_.steps));
        } else {
          go(BoundedSteps(scene_.T(), [&](double now) {
            return largest_step(first_, now, [&](double t) { return lemma_bound(t); });
          }));
        }
      } catch (const std::domain_error& error) {
        for (Member& m : members_) {
          if (!m.running) continue;
          m.growth->restore(m.values.u.values());
          m.result.failure = fmt::format("{} in step {}, from t = {:.6g} on", error.what(), m.result.steps + 1, m.t);
        }
      }
    });
    std::vector<CaseResult> results;
    for (Member& m : members_) {
      m.result.against_bound = m.bound.result();
      share_time(m, seconds);
      if (!stop_.load(std::memory_order_relaxed)) {
        conclude(m.result, m.c, *m.growth, m.values.u.values(), m.t, m.solution_at_first,
                 [&](double time) { return particles_->positions(time); });
        count_work(m);
        m.result.completed = true;
      }
      results.push_back(std::move(m.result));
    }
    return results;
  }

 private:
  void set_up(std::span<const Case* const> cases) {
    const auto count = static_cast<std::size_t>(first_.N);
    Needs needs;
    members_.reserve(cases.size());
    for (const Case* c : cases) {
      Member& m = members_.emplace_back(*c, count);
      add_source(m, count);
      const bool moving = !scene_.standing(), local = !c->scheme.nonlocal_divergence;
      needs.velocities |= c->scheme.model == 1 && moving;
      needs.b_prime |= local && moving;
      needs.midpoints |= c->scheme.model == 2 && moving;
      needs.phases |= m.source->is_series();
      // The side of a source is that of c_hat.
      needs.velocities |= c->scheme.model == 1 && m.source->is_series() && c->nonlocal_source;
      needs.delta = std::max(needs.delta, c->delta);
    }
    particles_.emplace(scene_, start_positions(first_.start, count, scene_.period()), needs, team_);
    particles_->move(0.0);
    for (Member& m : members_) {
      const auto fits = [&](const auto& group) { return group->takes(m.c); };
      const auto group = std::find_if(groups_.begin(), groups_.end(), fits);
      m.group = group != groups_.end() ? group->get()
                                       : groups_.emplace_back(std::make_unique<SweepGroup>(m.c, *particles_)).get();
      m.group->add(m.c, m.values);
      scene_.u(particles_->x.values(), 0.0, m.values.u.values());
      m.growth.emplace(m.values.u.values());
      m.solution_at_first = max_norm({m.values.u.values().begin(), m.values.u.values().end()});
      if (first_.integrator->stage_count() > 1) m.u_n.resize(count);
      m.lemma_bound = m.c.lemma_bound(1.0);
    }
  }

  void add_source(Member& m, std::size_t count) {
    const Case& c = m.c;
    if (!c.nonlocal_source) {
      if (!local_source_) {
        local_source_.emplace(
            scene_, [&](Look) { return local_source(scene_); }, false, true, count);
      }
      m.source = &*local_source_;
      return;
    }
    if (c.source_rule == SourceRule::gauss) {
      NonlocalModel model = nonlocal_model(c.scheme, c.mu, c.delta);
      const std::size_t points = c.source_refinement * sufficient_points(scene_, model);
      m.own_source.emplace(
          scene_, [&](Look look) { return nonlocal_source(scene_, model, points, look); }, c.scheme.model == 1, true,
          count);
    } else {
      m.own_source.emplace(
          scene_, [&](Look) { return make_source(c.scheme, scene_, c.mu, true, c.delta, c.source_rule); }, false, false,
          count);
    }
    m.source = &*m.own_source;
  }

  template <class Steps>
  void go(Steps steps) {
    const auto stages = first_.integrator->stages;
    std::int64_t n = 0;
    while (const std::optional<TimeStep> step = steps.next()) {
      for (Member& m : members_) {
        if (!m.u_n.empty()) std::copy(m.values.u.values().begin(), m.values.u.values().end(), m.u_n.begin());
      }
      for (const Stage& stage : stages) {
        const double t = step->at(stage.time);
        particles_->move(t);
        watch_bounds(step->dt);
        rates(t);
        for (Member& m : members_) {
          if (m.running) apply(stage, step->dt, m);
        }
      }
      ++n;
      if (!look(n, *step)) return;
    }
  }

  void rates(double t) {
    for (const auto& group : groups_) {
      if (!group->empty()) group->rates(team_);
    }
    if (local_source_) timed(source_seconds_, [&] { local_source_->evaluate(t, *particles_, team_); });
    for (Member& m : members_) {
      if (m.own_source && m.running) {
        timed(m.result.source_seconds, [&] { m.own_source->evaluate(t, *particles_, team_); });
      }
    }
  }

  void apply(const Stage& stage, double dt, Member& m) {
    team_.each(std::ssize(m.values.u), 64, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      apply_stage(stage.weight, dt, m.u_n.data(), m.values.rate.data(), m.source->f().data(),
                  m.values.u.values().data(), begin, end);
    });
  }

  void watch_bounds(double dt) {
    const double gap = particles_->smallest_gap();
    for (Member& m : members_) {
      // Where the smallest gap is matters only to a step beyond the bound.
      const double bound = m.lemma_bound * gap;
      m.bound.stage(bound, dt > bound ? particles_->place_of_smallest_gap() : 0.0);
    }
  }

  /// After a step; false if there is nothing more to do.
  bool look(std::int64_t n, TimeStep step) {
    bool any = false;
    for (Member& m : members_) {
      if (!m.running) continue;
      m.bound.step(n, step);
      count_step(m.result, n, step);
      m.t = step.end;
      const auto exact_size = [&] {
        std::vector<double> exact(particles_->size());
        scene_.u(particles_->positions(step.end), step.end, exact);
        return max_norm(exact);
      };
      m.running = m.growth->makes_sense(n, step.end, m.values.u.values(), exact_size);
      if (!m.running) m.group->remove(m.values);
      any |= m.running;
    }
    return any && !stop_.load(std::memory_order_relaxed);
  }

  /// The bound of the lemma, the same for all cases, at the particles of time t.
  double lemma_bound(double t) {
    particles_->move(t);
    return members_.front().lemma_bound * particles_->smallest_gap();
  }

  void share_time(Member& m, double seconds) {
    const auto count = static_cast<double>(members_.size());
    double of_groups = 0.0, of_own_sources = 0.0;
    for (const auto& group : groups_) of_groups += group->seconds;
    for (const Member& other : members_) of_own_sources += other.own_source ? other.result.source_seconds : 0.0;
    const auto in_group = static_cast<double>(
        std::count_if(members_.begin(), members_.end(), [&](const Member& other) { return other.group == m.group; }));
    const auto with_local_source = static_cast<double>(
        std::count_if(members_.begin(), members_.end(), [](const Member& other) { return !other.c.nonlocal_source; }));
    CaseResult& r = m.result;
    r.pairs_seconds = m.group->seconds / in_group;
    r.positions_seconds = particles_->positions_seconds / count;
    r.weights_seconds = particles_->velocities_seconds / count;
    if (!m.c.nonlocal_source) r.source_seconds = source_seconds_ / with_local_source;
    const double rest = seconds - of_groups - of_own_sources - source_seconds_ - particles_->positions_seconds -
                        particles_->velocities_seconds + setup_seconds_;
    r.seconds = r.pairs_seconds + r.positions_seconds + r.weights_seconds + r.source_seconds + rest / count;
  }

  void count_work(Member& m) {
    CaseResult& r = m.result;
    r.work = m.group->work();
    const std::int64_t placements = particles_->times_moved() * std::ssize(particles_->x);
    const bool local = !m.c.scheme.nonlocal_divergence;
    if (scene_.standing()) {
      r.work.velocity_evaluations = std::ssize(particles_->x);
    } else {
      r.work.velocity_evaluations = placements * ((m.c.scheme.model == 1 ? 2 : 0) + (local ? 1 : 0));
      r.flow_evaluations = placements - std::ssize(particles_->x);
    }
    r.quadrature_points = m.source->quadrature_points();
  }

  const std::atomic<bool>& stop_;
  Team team_;
  const Scene& scene_;
  const Case& first_;
  std::optional<SharedParticles> particles_;
  std::vector<Member> members_;
  std::vector<std::unique_ptr<SweepGroup>> groups_;
  std::optional<ParticleSource> local_source_;
  double source_seconds_ = 0.0, setup_seconds_ = 0.0;
};

}  // namespace

std::vector<CaseResult> run_ensemble(std::span<const Case* const> cases, int threads, const std::atomic<bool>& stop) {
  return Ensemble(cases, threads, stop).run();
}

}  // namespace acstudy
