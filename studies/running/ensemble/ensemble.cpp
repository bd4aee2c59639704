#include "studies/running/ensemble/ensemble.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "studies/models/scheme.hpp"
#include "studies/running/ensemble/member.hpp"
#include "studies/running/outcome.hpp"
#include "studies/running/step_rule.hpp"
#include "studies/running/stopwatch.hpp"

namespace acstudy {

namespace {

class Ensemble {
 public:
  Ensemble(std::span<const Plan> plans, int threads, const std::atomic<bool>& stop, double most_seconds)
      : stop_(stop),
        most_seconds_(most_seconds),
        team_(threads),
        scene_(*plans.front().c->scene),
        first_(*plans.front().c) {
    timed(setup_seconds_, [&] { set_up(plans); });
  }

  std::vector<CaseResult> run() {
    double seconds = 0.0;
    timed(seconds, [&] {
      try {
        go();
      } catch (const std::domain_error& error) {
        for (Member& m : members_) {
          if (!m.running) continue;
          m.take_back(stages_done_);
          m.result.failure = failure_in_step(error, m.result, m.t);
        }
      }
    });
    std::vector<CaseResult> results;
    for (Member& m : members_) {
      m.result.against_bound = m.bound.result();
      share_time(m, seconds);
      if (!m.put_off && !(m.running && interrupted_)) {
        conclude(
            m.result, m.c, *m.growth, m.values.u.values(), m.t, m.solution_at_first,
            [&](double time) { return particles_->positions(time); },
            [&](const Points& x) { return widths_on_line(x.line(), scene_.period()); });
        count_work(m);
        m.result.completed = true;
      }
      results.push_back(std::move(m.result));
    }
    return results;
  }

 private:
  void set_up(std::span<const Plan> plans) {
    const auto count = static_cast<std::size_t>(first_.N);
    Needs needs;
    members_.reserve(plans.size());
    for (const Plan& plan : plans) {
      const Case* const c = plan.c;
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
      needs.c_hat |= c->nonlocal_source && m.source->is_series() && c->scheme.model->continuum->sided;
      needs.rows = c->integrator->implicit();
      needs.delta = std::max(needs.delta, c->delta);
    }
    particles_.emplace(scene_, *plans.front().velocity, start_positions(first_.start, count, scene_.period()), needs,
                       team_);
    PerThread<double> largest(team_, 0.0);
    particles_->move(0.0, [&](const Piece& piece, Laps&) {
      const auto u = piece.of(members_.front().values.u.values());
      scene_.initial(piece.of(particles_->x.values()), u);
      for (const double value : u) largest[piece] = larger(largest[piece], std::abs(value));
      for (Member& m : std::span(members_).subspan(1)) {
        std::copy(u.begin(), u.end(), piece.of(m.values.u.values()).begin());
      }
    });
    for (std::size_t i = 0; i < members_.size(); ++i) {
      Member& m = members_[i];
      const auto fits = [&](const auto& group) { return group->takes(m.c); };
      auto group = std::find_if(groups_.begin(), groups_.end(), fits);
      if (group == groups_.end()) {
        const bool far = plans[i].form->far;
        group = groups_.insert(group, std::make_unique<SweepGroup>(m.c, *particles_, far));
      }
      m.group = group->get();
      m.group->add(m.c, m.values);
      m.growth.emplace(largest.all(larger));
      m.solution_at_first = m.largest_before = largest.all(larger);
      m.lemma_bound = m.c.lemma_bound(1.0);
      least_limit_ = std::min(least_limit_, m.c.limit);
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

  void go() {
    const auto start = std::chrono::steady_clock::now();
    std::int64_t n = 0;  // steps, and those taken back
    const auto take = [&](const TimeStep& step) {
      // Times are taken in all of the first steps and then in the middle one of every sixteen.
      team_.weigh(n < 64 ? 1.0 : n % 16 == 8 ? 16.0 : 0.0);
      ++n;
      for (std::size_t i = 1; i <= first_.integrator->stage_count(); ++i) {
        advance(i, step);
      }
      stages_done_ = 0;
    };
    const auto goes_on = [&](std::int64_t done, const TimeStep& step) {
      if (!look(done, step)) return false;
      if (std::isfinite(least_limit_) && step.end < scene_.T() && !within_limits(start)) return false;
      if (!weighed_up_ && std::isfinite(most_seconds_) && (n <= 64 || n % 16 == 0)) {
        const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (elapsed > 0.1 * most_seconds_) weigh_up(elapsed, step.end / scene_.T());
      }
      interrupted_ = step.end < scene_.T() && stop_.load(std::memory_order_relaxed);
      return !interrupted_;
    };
    // A case of adaptive steps is alone: it is the one whose error decides.
    Member& only = members_.front();
    step_to_end(
        first_, [&](double t) { return bound(t); },
        StepActions{take, [&](double tolerance) { return only.error_over(tolerance); }, [&] { only.reject(); }},
        goes_on);
  }

  /// Ends cases whose share of the time since `start` is above their limit; false if no case is left.
  bool within_limits(std::chrono::steady_clock::time_point start) {
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (elapsed + setup_seconds_ <= least_limit_) return true;
    bool any = false;
    for (Member& m : members_) {
      if (!m.running) continue;
      share_time(m, elapsed);
      m.running = !gave_out(m.result, m.c, m.result.seconds, m.t);
      if (!m.running) m.group->remove(m.values);
      any |= m.running;
    }
    return any;
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

  /// Stage i: its explicit part, and what is solved for.
  void advance(std::size_t i, const TimeStep& step) {
    const Integrator& integrator = *first_.integrator;
    const std::size_t newest = i - 1;
    for (Member& m : members_) m.start_stage();
    if (integrator.diagonal(newest) == 0.0 && integrator.asks_for_rate(newest, newest)) {
      advance_by_rates(i, step);
    } else {
      team_.each(std::ssize(particles_->x), 32,
                 [&](const Piece& piece) { each_running([&](Member& m) { m.stage(i, step.dt, piece); }); });
    }
    each_running([&](Member& m) { m.accept(i); });
    stages_done_ = i;
    if (integrator.diagonal(i) != 0.0) solve(i, step);
  }

  /// In as few passes over the particles as there are times that all must wait for each other: first what each of them
  /// needs no neighbor for, then for each group its sums, from which its cases step on.
  void advance_by_rates(std::size_t i, const TimeStep& step) {
    move(step.at(first_.integrator->c(i - 1)));
    watch_bounds(step.dt);
    for (const auto& group : groups_) {
      if (group->empty()) continue;
      group->rates(team_, [&](const Piece& piece) {
        each_running([&](Member& m) {
          if (m.group == group.get()) m.stage(i, step.dt, piece);
        });
      });
    }
  }

  /// Particles, velocities and sources at time t.
  void move(double t) {
    each_source([&](ParticleSource& source) { team_.timed(source.seconds, [&] { source.find_series(t); }); });
    particles_->move(t, [&](const Piece& piece, Laps& laps) {
      each_source([&](ParticleSource& source) { source.evaluate_series(*particles_, piece, laps); });
      for (const auto& group : groups_) group->prepare(piece, laps);
    });
    each_source([&](ParticleSource& source) {
      team_.timed(source.seconds, [&] { source.evaluate_directly(t, *particles_); });
    });
  }

  /// The implicit part of stage i.
  void solve(std::size_t i, const TimeStep& step) {
    const double scale = first_.integrator->diagonal(i) * step.dt;
    move(step.at(first_.integrator->c(i)));
    const auto each_piece = [&](auto what) {
      team_.each(std::ssize(particles_->x), 32,
                 [&](const Piece& piece) { each_running([&](Member& m) { what(m, piece); }); });
    };
    each_piece([&](Member& m, const Piece& piece) { m.add_source(i, scale, piece); });
    for (const auto& group : groups_) {
      if (!group->empty()) group->solve(team_, scale);
    }
    each_running([&](Member& m) {
      if (m.values.failure.empty()) return;
      m.take_back(i);
      m.result.failure = failure_in_step(std::domain_error(m.values.failure), m.result, m.t);
      m.running = false;
      m.group->remove(m.values);
    });
    for (Member& m : members_) m.start_stage();
    each_piece([&](Member& m, const Piece& piece) { m.finish_solved(i, scale, piece); });
  }

  template <class Do>
  void each_running(Do&& what) {
    for (Member& m : members_) {
      if (m.running) what(m);
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

  /// Compares steps with the bound of the lemma; there is none of implicit ones.
  void watch_bounds(double dt) {
    if (first_.integrator->implicit()) return;
    const double gap = particles_->smallest_gap();
    for (Member& m : members_) {
      // Where the smallest gap is matters only to a step beyond the bound.
      const double bound = m.lemma_bound * gap;
      m.bound.stage(bound, dt > bound ? particles_->place_of_smallest_gap() : 0.0);
    }
  }

  /// After a step; false if there is nothing more to do.
  bool look(std::int64_t n, const TimeStep& step) {
    bool any = false;
    for (Member& m : members_) {
      if (!m.running) continue;
      m.bound.step(n, step);
      count_step(m.result, n, step);
      m.t = step.end;
      const auto exact_size = [&] { return scene_.solution_size(particles_->positions(step.end), step.end); };
      const double largest = m.largest_before = m.largest.all(larger);
      m.running = m.growth->makes_sense(n, step.end, m.values.u.values(), largest, exact_size);
      if (!m.running) {
        if (!std::isfinite(largest)) m.take_back(first_.integrator->stage_count());
        m.group->remove(m.values);
      }
      any |= m.running;
    }
    return any;
  }

  /// The bound that steps follow, the same for all cases, at the particles of time t.
  double bound(double t) {
    particles_->move(t);
    if (first_.step.bound == StepRule::Bound::rows) return 1.0 / groups_.front()->strongest_decay(team_);
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
  double least_limit_ = std::numeric_limits<double>::infinity();  ///< of all cases
  bool interrupted_ = false, weighed_up_ = false;
  Team team_;
  const Scene& scene_;
  const Case& first_;
  std::optional<SharedParticles> particles_;
  std::vector<Member> members_;
  std::vector<std::unique_ptr<SweepGroup>> groups_;
  std::optional<ParticleSource> local_source_;
  std::size_t stages_done_ = 0;  ///< of a step that is not finished
  double setup_seconds_ = 0.0;
};

}  // namespace

std::vector<CaseResult> run_ensemble(std::span<const Plan> plans, int threads, const std::atomic<bool>& stop,
                                     double most_seconds) {
  return Ensemble(plans, threads, stop, most_seconds).run();
}

}  // namespace acstudy
