#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "studies/claims/extreme_rows.hpp"

namespace acstudy {

namespace {

const std::string mass_drift = "mass drift";
const std::string relative_drift = "relative drift of sum V_j u_j: largest over t, root mean square over runs";

/// sum V_j u_j, V_j half the distance between the two neighbors of particle j.
double mass(std::span<const double> x, std::span<const double> u, double period) {
  double sum = 0.0;
  for (std::size_t j = 0; j < x.size(); ++j) {
    const double right = j + 1 < x.size() ? x[j + 1] : x[0] + period, left = j > 0 ? x[j - 1] : x.back() - period;
    sum += 0.5 * (right - left) * u[j];
  }
  return sum;
}

/// A run and how its mass is followed.
struct MassRun {
  Subject subject;
  double T;
  std::optional<double> ratio, horizon;  ///< delta = ratio h, or fixed

  double delta(double h) const { return ratio ? *ratio * h : *horizon; }
};

/// The largest drift over a run without source from u = 1 + cos(2 pi x / period - phase)/2 > 0; the root mean square
/// over three phases and all arrangements, since the drift of a single run may pass through zero as h is refined.
Point drift_of(const MassRun& run, std::int64_t N) {
  const Scene& scene = *run.subject.scene;
  const double period = scene.period(), h = period / static_cast<double>(N), delta = run.delta(h);
  Point point{.N = N, .h = h, .delta = delta, .variable = h};
  double squares = 0.0, runs = 0.0;
  for (const std::vector<double>& x : run.subject.positions(N)) {
    Particles particles(x.size(), period, delta);
    particles.place(x);
    // The gaps of moving particles close by the factor e.
    const double dt = (scene.standing() ? 0.5 : 0.125) * step_at_cfl_one(run.subject, x, delta);
    const std::int64_t steps = steps_for(run.T, dt);
    // Each step rounds every value; a sum rounds with every term.
    point.upper = static_cast<double>(steps + 2 * N) * step_round_off(run.subject, particles);
    for (const double phase : {0.0, 2.0, 4.0}) {
      const std::vector<double> u =
          values_at(x, [&](double y) { return 1.0 + 0.5 * std::cos(2.0 * std::numbers::pi * y / period - phase); });
      const double start = mass(x, u, period);
      double drift = 0.0;
      run_freely(run.subject, {x, u}, delta, run.T, steps,
                 [&](const TimeStep&, std::span<const double> x_now, std::span<const double> u_now) {
                   const double now = std::abs(mass(x_now, u_now, period) / start - 1.0);
                   if (worse(now, drift)) drift = now;
                 });
      squares += drift * drift;
      runs += 1.0;
    }
  }
  point.value = std::sqrt(squares / runs);
  return point;
}

void add_conserved(ExtremeRows& rows, const SchemeChoice& scheme) {
  struct Velocity {
    std::string c, claim;
    bool any_sign;
  };
  const std::vector<Velocity> velocities = {
      {"1", "standing, equal gaps, c constant: conserved to round-off", false},
      {"1 + sin(2*pi*x)/2", "standing, equal gaps, c > 0 varying: conserved to round-off", false},
      {"sin(2*pi*x)",
       fmt::format("standing, equal gaps, c of both signs: {} conserves to round-off", scheme.model->name), true}};
  const auto measure = [](Finding& row, const Subject& subject) {
    for (const double ratio : {0.5, 3.5}) row.points.push_back(drift_of({subject, 0.25, ratio, {}}, 80));
  };
  for (const Velocity& velocity : velocities) {
    if (velocity.any_sign && !scheme.model->conserves_any_sign) continue;
    const auto named = [&](const Subject& subject) {
      return subject.check(mass_drift, velocity.claim, {velocity_is(velocity.c), {"bound", "to round-off"}},
                           relative_drift);
    };
    const Subject subject = subject_on(scheme, scene_with(velocity.c));
    const Subject jittered = subject_on(scheme, scene_with(velocity.c), Arrangement::jittered);
    rows.add(named(subject), [=](Finding& row) { measure(row, subject); });
    rows.add_control(named(jittered), "its gaps are not equal", [=](Finding& row) { measure(row, jittered); });
  }
}

/// A scheme that does not conserve drifts by its consistency error.
void add_drifting(ExtremeRows& rows, const SchemeChoice& scheme, std::int64_t levels) {
  const auto measure = [levels](Finding& row, const MassRun& run) {
    // Where gaps are random so is the drift: many small arrangements say more of it than few large ones.
    const bool random = run.subject.arrangement == Arrangement::jittered;
    const std::int64_t coarsest = random ? 20 : 40;
    for (std::int64_t level = 0; level < levels; ++level) {
      row.points.push_back(drift_of(run, coarsest << level));
      row.points.back().upper = std::numeric_limits<double>::infinity();
    }
  };
  const auto named = [](const MassRun& run, const Coordinate& fields) {
    Check check = run.subject.check(
        mass_drift, "elsewhere mass is not conserved, and its drift vanishes with order 1 at least",
        {fields, run.ratio ? at_ratio(*run.ratio) : at_horizon(*run.horizon)}, relative_drift, Test::rate);
    check.theory_order = 1.0;
    return check;
  };
  const auto add = [&](const Subject& subject, double T, const Coordinate& fields) {
    for (const double ratio : {0.5, 3.5}) {
      const MassRun run{subject, T, ratio, {}};
      rows.add(named(run, fields), [=](Finding& row) { measure(row, run); });
    }
  };
  const auto add_control = [&](const MassRun& run, const Coordinate& fields, const std::string& why) {
    Check control = named(run, fields);
    control.also_expected = {Verdict::diverges};  // it settles, be it from below
    rows.add_control(
        control, why, [=](Finding& row) { measure(row, run); }, Verdict::stagnates);
  };

  if (!scheme.nonlocal_divergence) {
    // exp(2 pi T), by which u grows where c changes sign, is 2.2.
    const Subject both_signs = subject_on(scheme, scene_with("sin(2*pi*x)"));
    if (!scheme.model->conserves_any_sign) {
      add(both_signs, 0.125, velocity_is("sin(2*pi*x)"));
      add_control(
          {both_signs, 0.125, {}, 0.1}, velocity_is("sin(2*pi*x)"),
          fmt::format("the nonlocal {} does not conserve at zeros of c, however small h is", scheme.model->name));
    }
    for (const std::string c : {"1", "1 + sin(2*pi*x)/2"}) {
      Subject jittered = subject_on(scheme, scene_with(c), Arrangement::jittered);
      jittered.seeds = 96;
      add(jittered, 0.25, velocity_is(c));
    }
  }
  const Subject moving = subject_on(scheme, scene_named("lee-du-2019"));
  add(moving, moving.scene->T(), on_scene("lee-du-2019"));
  add_control({*mistaken(moving, "no divergence term"), moving.scene->T(), 3.5, {}}, on_scene("lee-du-2019"),
              "without b' u there is more mass where the volumes grow");
}

}  // namespace

void add_rows_of_mass(ExtremeRows& rows, const Extremes& extremes) {
  for (const SchemeChoice& scheme : standing_schemes(extremes)) add_conserved(rows, scheme);
  for (const SchemeChoice& scheme : extremes.schemes) add_drifting(rows, scheme, extremes.levels);
}

}  // namespace acstudy
