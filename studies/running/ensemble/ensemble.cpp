#include "studies/running/ensemble/ensemble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include "mms/source_series.hpp"
#include "solver/time/integrators.hpp"
#include "solver/vector/clones.hpp"
#include "studies/models/scheme.hpp"
#include "studies/running/ensemble/shared_particles.hpp"
#include "studies/running/ensemble/sweep_group.hpp"
#include "studies/running/outcome.hpp"
#include "studies/running/stopwatch.hpp"
#include "studies/running/watch.hpp"

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
  if (c.integrator->implicit() || c.scheme.control != nullptr || c.step.bound == StepRule::Bound::rows) return false;
  if (c.scene->standing()) return true;
  switch (c.scheme.model->vector_form) {
    case VectorForm::none:
      return false;
    case VectorForm::upwind:
      return true;
    case VectorForm::symmetric:
      return midpoint_modes(VelocitySeries(*c.scene)) || VelocityPanels::find(*c.scene, panel_reach(c));
  }
  return false;
}

std::string ensemble_key(const Case& c) {
  const SceneText& text = c.scene->text();
  const std::string bound =
      c.step.bound == StepRule::Bound::none ? "" : fmt::format("|{:.17g}", c.step.safety * c.lemma_bound(1.0));
  return fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}{}|{}{:.17g}", text.period, text.T, text.c, text.b.value_or(""),
                     text.solution(), text.flow.value_or(""), c.integrator->name, c.N, c.steps, bound, c.start.label(),
                     c.start.smallest_gap);
}

std::string sweep_key(const Case& c) {
  return fmt::format("{}|{}|{:.17g}|{:.17g}", c.scheme.model->number, c.scheme.kernel.label(), c.delta, c.mu);
}

namespace {

/// next = (1 - weight) u^n + weight (u + dt (rate + f)) at some particles.
/// @return  the largest |next|; NaN if one is not finite
ACSTUDY_VECTOR_CLONES double apply_stage(double weight, double dt, const double* u_n, const double* u,
                                         const double* rate, const double* f, double* next, std::ptrdiff_t count) {
  double largest = 0.0, sum = 0.0;
#pragma omp simd reduction(max : largest) reduction(+ : sum)
  for (std::ptrdiff_t j = 0; j < count; ++j) {
    const double value = (1.0 - weight) * u_n[j] + weight * (u[j] + dt * (rate[j] + f[j]));
    next[j] = value;
    largest = std::abs(value) > largest ? std::abs(value) : largest;
    sum += 0.0 * value;  // NaN if the value is not finite, which the comparison passes over
  }
  return largest + sum;
}

/// The larger of two sizes; NaN if one is.
double larger(double a, double b) { return a > b || std::isnan(a) ? a : b; }

/// A source at all particles, by its series if it has one; zero, and never computed, where the scene has none.
class ParticleSource {
 public:
  ParticleSource(const Scene& scene, const SourceSeries::MakeSource& make, bool sided, bool may_be_series,
                 std::size_t count)
      : f_(count) {
    if (scene.sourceless()) return;
    // More samples than particles would be no saving.
    if (may_be_series) series_ = SourceSeries::find(scene, make, sided, std::min<std::size_t>(count / 2, 96));
    if (!series_) direct_ = make(Look::upwind);
  }
  bool is_series() const { return series_.has_value(); }

  // f at time t: by a series, which is found once for all pieces of particles, or directly for all particles.
  void find_series(double t) {
    if (series_) series_->at(t);
  }
  void evaluate_series(const SharedParticles& particles, const Piece& piece, Laps& laps) {
    if (!series_) return;
    const auto c_hat = series_->sided() ? piece.of(particles.c_hat.values()) : std::span<const double>();
    series_->evaluate(particles.phases(piece), c_hat, piece.of(std::span(f_)));
    laps.end_of(seconds);
  }
  void evaluate_directly(double t, const SharedParticles& particles) {
    if (!direct_) return;
    if (placed_ != particles.times_moved()) direct_->place(particles.x.values());
    placed_ = particles.times_moved();
    direct_->evaluate(t, f_);
  }

  const double* f() const { return f_.data(); }
  std::int64_t quadrature_points() const {
    return series_ ? series_->quadrature_points() : direct_ ? direct_->quadrature_points() : 0;
  }

  double seconds = 0.0;

 private:
  std::optional<SourceSeries> series_;
  std::unique_ptr<Source> direct_;
  std::int64_t placed_ = 0;  ///< the move of the particles after which `direct_` was placed
  ZeroedVector f_;
};

/// A case on its way.
struct Member {
  Member(const Case& its_case, std::size_t count, const Team& team)
      : c(its_case),
        values{PeriodicArray(count),
               PeriodicArray(
                   its_case.scheme.model->vector_form == VectorForm::upwind && !its_case.scene->standing() ? count : 0),
               ZeroedVector(count + 16)},
        next(count),
        u_n(its_case.integrator->stage_count() > 1 ? count : 0),
        largest(team, 0.0) {}

  /// u at the start of the step, from its first stage to that of the next.
  PeriodicArray& before() { return u_n.size() > 0 ? u_n : next; }

  /// Takes what a stage has made of u.
  void accept(bool first_stage) {
    std::swap(values.u, next);
    if (first_stage && u_n.size() > 0) std::swap(next, u_n);
  }

  const Case& c;
  CaseResult result;
  SweptValues values;
  PeriodicArray next;  ///< what becomes of u
  PeriodicArray u_n;   ///< at the start of the step, where there are several stages
  SweepGroup* group = nullptr;
  ParticleSource* source = nullptr;
  std::optional<ParticleSource> own_source;
  std::optional<GrowthWatch> growth;
  BoundWatch bound;
  double lemma_bound = 0.0;  ///< for a smallest gap of 1
  double solution_at_first = 0.0;
  PerThread<double> largest;  ///< |u| after the last stage
  double t = 0.0;
  bool running = true;
  bool put_off = false;  ///< left where it is, to be run another time
};

class Ensemble {
 public:
  Ensemble(std::span<const Case* const> cases, int threads, const std::atomic<bool>& stop, double most_seconds)
      : stop_(stop),
        most_seconds_(most_seconds),
        team_(threads),
        scene_(*cases.front()->scene),
        first_(*cases.front()) {
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
          if (stages_done_ > 0) std::swap(m.values.u, m.before());
          m.result.failure = fmt::format("{} in step {}, from t = {:.6g} on", error.what(), m.result.steps + 1, m.t);
        }
      }
    });
    std::vector<CaseResult> results;
    for (Member& m : members_) {
      m.result.against_bound = m.bound.result();
      share_time(m, seconds);
      if (!m.put_off && !(m.running && interrupted_)) {
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
      Member& m = members_.emplace_back(*c, count, team_);
      add_source(m, count);
      const bool moving = !scene_.standing(), local = !c->scheme.nonlocal_divergence;
      const VectorForm form = c->scheme.model->vector_form;
      needs.c_hat |= form == VectorForm::upwind && moving;
      needs.c_and_b |= form == VectorForm::upwind && moving && !local;
      needs.b_prime |= local && moving;
      needs.midpoints |= form == VectorForm::symmetric && moving;
      needs.phases |= m.source->is_series();
      // The side of a source is that of c_hat.
      needs.c_hat |= c->scheme.model->continuum->sided && m.source->is_series() && c->nonlocal_source;
      needs.delta = std::max(needs.delta, c->delta);
    }
    particles_.emplace(scene_, start_positions(first_.start, count, scene_.period()), needs, team_);
    PerThread<double> largest(team_, 0.0);
    particles_->move(0.0, [&](const Piece& piece, Laps&) {
      const auto u = piece.of(members_.front().values.u.values());
      scene_.initial(piece.of(particles_->x.values()), u);
      for (const double value : u) largest[piece] = larger(largest[piece], std::abs(value));
      for (Member& m : std::span(members_).subspan(1)) {
        std::copy(u.begin(), u.end(), piece.of(m.values.u.values()).begin());
      }
    });
    for (Member& m : members_) {
      const auto fits = [&](const auto& group) { return group->takes(m.c); };
      const auto group = std::find_if(groups_.begin(), groups_.end(), fits);
      m.group = group != groups_.end() ? group->get()
                                       : groups_.emplace_back(std::make_unique<SweepGroup>(m.c, *particles_)).get();
      m.group->add(m.c, m.values);
      m.growth.emplace(largest.all(larger));
      m.solution_at_first = largest.all(larger);
      m.lemma_bound = m.c.lemma_bound(1.0);
    }
  }

  void add_source(Member& m, std::size_t count) {
    const Case& c = m.c;
    if (!c.nonlocal_source) {
      if (!local_source_) {
        local_source_.emplace(
            scene_, [&](Look) { return local_source(scene_); }, false, scene_.solved(), count);
      }
      m.source = &*local_source_;
      return;
    }
    if (c.source_rule == SourceRule::gauss) {
      NonlocalModel model = nonlocal_model(c.scheme, c.mu, c.delta);
      const std::size_t points = c.source_refinement * sufficient_points(scene_, model);
      m.own_source.emplace(
          scene_, [&](Look look) { return nonlocal_source(scene_, model, points, look); },
          c.scheme.model->continuum->sided, true, count);
    } else {
      m.own_source.emplace(
          scene_, [&](Look) { return make_source(c.scheme, scene_, c.mu, true, c.delta, c.source_rule); }, false, false,
          count);
    }
    m.source = &*m.own_source;
  }

  template <class Steps>
  void go(Steps steps) {
    const auto start = std::chrono::steady_clock::now();
    std::int64_t n = 0;
    while (const std::optional<TimeStep> step = steps.next()) {
      interrupted_ = stop_.load(std::memory_order_relaxed);
      if (interrupted_) return;
      // Times are taken in all of the first steps and then in the middle one of every sixteen.
      team_.weigh(n < 64 ? 1.0 : n % 16 == 8 ? 16.0 : 0.0);
      for (const Stage& stage : first_.integrator->stages) {
        advance(stage, *step);
        ++stages_done_;
      }
      stages_done_ = 0;
      ++n;
      if (!look(n, *step)) return;
      if (!weighed_up_ && std::isfinite(most_seconds_) && (n <= 64 || n % 16 == 0)) {
        const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (elapsed > 0.1 * most_seconds_) weigh_up(elapsed, step->end / scene_.T());
      }
    }
  }

  /// Puts groups off if all would take much longer than is wanted, by what this part of the run has taken. What is put
  /// off pays for positions and the source of the PDE again, so more are kept where these are dear.
  void weigh_up(double elapsed, double part) {
    weighed_up_ = true;
    const auto own_seconds = [&](const SweepGroup& group) {
      double own = group.seconds;
      for (const Member& m : members_) own += m.group == &group && m.own_source ? m.own_source->seconds : 0.0;
      return own;
    };
    double shared = elapsed;
    for (const auto& group : groups_) shared -= own_seconds(*group);
    const double wanted = std::max(most_seconds_, 4.0 * shared / part);
    if (elapsed / part <= 1.5 * wanted) return;
    double seconds = shared / part;
    bool any = false;
    for (const auto& group : groups_) {
      if (group->empty()) continue;
      const double own = own_seconds(*group) / part;
      if (!any || seconds + own <= wanted) {
        any = true;
        seconds += own;
        continue;
      }
      for (Member& m : members_) {
        if (!m.running || m.group != group.get()) continue;
        m.running = false;
        m.put_off = true;
        group->remove(m.values);
      }
    }
  }

  /// One stage, in as few passes over the particles as there are times that all must wait for each other: first what
  /// each of them needs no neighbor for, then for each group its sums, from which its cases step on.
  void advance(const Stage& stage, TimeStep step) {
    const double t = step.at(stage.time);
    const bool first_stage = &stage == &first_.integrator->stages.front();
    each_source([&](ParticleSource& source) { team_.timed(source.seconds, [&] { source.find_series(t); }); });
    particles_->move(t, [&](const Piece& piece, Laps& laps) {
      each_source([&](ParticleSource& source) { source.evaluate_series(*particles_, piece, laps); });
      for (const auto& group : groups_) group->prepare(piece, laps);
    });
    watch_bounds(step.dt);
    each_source([&](ParticleSource& source) {
      team_.timed(source.seconds, [&] { source.evaluate_directly(t, *particles_); });
    });
    for (Member& m : members_) m.largest.fill(0.0);
    for (const auto& group : groups_) {
      if (group->empty()) continue;
      group->rates(team_, [&](const Piece& piece) {
        for (Member& m : members_) {
          if (!m.running || m.group != group.get()) continue;
          const std::ptrdiff_t j = piece.begin;
          const double here =
              apply_stage(stage.weight, step.dt, first_stage ? m.values.u.at(j) : m.u_n.at(j), m.values.u.at(j),
                          m.values.rate.data() + j, m.source->f() + j, &m.next[j], piece.size());
          m.largest[piece] = larger(m.largest[piece], here);
        }
      });
    }
    for (Member& m : members_) {
      if (m.running) m.accept(first_stage);
    }
  }

  /// Every source that some case still needs.
  template <class Do>
  void each_source(Do&& what) {
    if (local_source_) what(*local_source_);
    for (Member& m : members_) {
      if (m.own_source && m.running) what(*m.own_source);
    }
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
      const auto exact_size = [&] { return scene_.solution_size(particles_->positions(step.end), step.end); };
      const double largest = m.largest.all(larger);
      m.running = m.growth->makes_sense(n, step.end, m.values.u.values(), largest, exact_size);
      if (!m.running) {
        if (!std::isfinite(largest)) std::swap(m.values.u, m.before());
        m.group->remove(m.values);
      }
      any |= m.running;
    }
    return any;
  }

  /// The bound of the lemma, the same for all cases, at the particles of time t.
  double lemma_bound(double t) {
    particles_->move(t);
    return members_.front().lemma_bound * particles_->smallest_gap();
  }

  void share_time(Member& m, double seconds) {
    const auto with = [&](auto has) {
      return static_cast<double>(std::count_if(members_.begin(), members_.end(),
                                               [&](const Member& other) { return !other.put_off && has(other); }));
    };
    if (m.put_off) return;
    const double count = with([](const Member&) { return true; });
    double of_groups = 0.0, of_sources = 0.0;
    for (const auto& group : groups_) of_groups += group->seconds;
    if (local_source_) of_sources += local_source_->seconds;
    for (const Member& other : members_) of_sources += other.own_source ? other.own_source->seconds : 0.0;
    CaseResult& r = m.result;
    r.pairs_seconds = m.group->seconds / with([&](const Member& other) { return other.group == m.group; });
    r.positions_seconds = particles_->positions_seconds / count;
    r.weights_seconds = particles_->velocities_seconds / count;
    r.source_seconds = m.source->seconds / with([&](const Member& other) { return other.source == m.source; });
    const double rest = seconds - of_groups - of_sources - particles_->positions_seconds -
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
      r.work.velocity_evaluations =
          placements * ((m.c.scheme.model->vector_form == VectorForm::upwind ? 2 : 0) + (local ? 1 : 0));
      r.flow_evaluations = placements - std::ssize(particles_->x);
    }
    r.quadrature_points = m.source->quadrature_points();
  }

  const std::atomic<bool>& stop_;
  double most_seconds_;
  bool interrupted_ = false, weighed_up_ = false;
  Team team_;
  const Scene& scene_;
  const Case& first_;
  std::optional<SharedParticles> particles_;
  std::vector<Member> members_;
  std::vector<std::unique_ptr<SweepGroup>> groups_;
  std::optional<ParticleSource> local_source_;
  int stages_done_ = 0;  ///< of a step that is not finished
  double setup_seconds_ = 0.0;
};

}  // namespace

std::vector<CaseResult> run_ensemble(std::span<const Case* const> cases, int threads, const std::atomic<bool>& stop,
                                     double most_seconds) {
  return Ensemble(cases, threads, stop, most_seconds).run();
}

}  // namespace acstudy
