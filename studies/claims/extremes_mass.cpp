#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "studies/claims/extreme_rows.hpp"

namespace acstudy {

namespace {

const std::string statement = "mass drift";

/// sum V_j u_j, V_j half the distance between the two neighbors of particle j.
double mass(const State& state, double period, bool of_size = false) {
  const auto& [x, u] = state;
  double sum = 0.0;
  for (std::size_t j = 0; j < x.size(); ++j) {
    const double right = j + 1 < x.size() ? x[j + 1] : x[0] + period, left = j > 0 ? x[j - 1] : x.back() - period;
    sum += 0.5 * (right - left) * (of_size ? std::abs(u[j]) : u[j]);
  }
  return sum;
}

/// The drift over a run without source from u = 1 + sin(2 pi x / period)/2, the largest of all arrangements.
Point drift_of(const Subject& subject, std::int64_t N, double ratio) {
  const Scene& scene = *subject.scene;
  const double period = scene.period(), h = period / static_cast<double>(N);
  Point point{.N = N, .h = h, .delta = ratio * h, .variable = h, .value = 0.0};
  for (const std::vector<double>& x : subject.positions(N)) {
    const State start{
        x, values_at(x, [&](double y) { return 1.0 + 0.5 * std::sin(2.0 * std::numbers::pi * y / period); })};
    // The gaps of moving particles close by the factor e.
    const double dt = (scene.standing() ? 0.5 : 0.125) * step_at_cfl_one(subject, x, ratio * h);
    const std::int64_t steps = steps_for(scene.T(), dt);
    const State end = run_freely(subject, start, ratio * h, scene.T(), steps);
    const double drift = std::abs(mass(end, period) - mass(start, period)) / mass(start, period, true);
    Particles particles(x.size(), period, ratio * h);
    particles.place(x);
    // Each step rounds every value, the sums round with every term.
    point.upper = static_cast<double>(steps + N) * row_round_off(particles);
    if (worse(drift, point.value)) point.value = drift;
  }
  return point;
}

const std::vector<double> ratios = {0.5, 3.5};

void add_conserved(ExtremeRows& rows, const SchemeChoice& scheme) {
  const auto measure = [](Finding& row, const Subject& subject) {
    for (const double ratio : ratios) row.points.push_back(drift_of(subject, 80, ratio));
    row.variable = "h";
  };
  const std::string quantity = "|change of sum V_j u_j| / sum V_j |u_j|";
  struct Velocity {
    std::string c, claim;
    bool model2_alone;
  };
  const std::vector<Velocity> velocities = {
      {"1", "standing, equal gaps, c constant: conserved to round-off", false},
      {"1 + sin(2*pi*x)/2", "standing, equal gaps, c > 0 varying: conserved to round-off", false},
      {"sin(2*pi*x)", "standing, equal gaps, c of both signs: Model II conserves to round-off", true}};
  for (const Velocity& velocity : velocities) {
    if (velocity.model2_alone && scheme.model == 1) continue;
    const auto named = [&](const Subject& subject) {
      return subject.finding(statement, velocity.claim, "c = " + velocity.c, quantity, Test::bounds);
    };
    const Subject subject = subject_on(scheme, scene_with(velocity.c));
    const Subject jittered = subject_on(scheme, scene_with(velocity.c), Arrangement::jittered);
    rows.add(named(subject), [=](Finding& row) { measure(row, subject); });
    rows.add_control(named(jittered), "its gaps are not equal", [=](Finding& row) { measure(row, jittered); });
  }
}

/// Where a scheme is not conservative, mass drifts by its consistency error.
void add_drifting(ExtremeRows& rows, const SchemeChoice& scheme) {
  const std::string quantity = "|change of sum V_j u_j| / sum V_j |u_j|";
  const auto measure = [](Finding& row, const Subject& subject, double ratio) {
    for (const std::int64_t N : {40, 80, 160, 320, 640}) {
      row.points.push_back(drift_of(subject, N, ratio));
      row.points.back().upper = std::numeric_limits<double>::infinity();
    }
    row.variable = "h";
  };
  const auto add = [&](const Subject& subject, const std::string& claim, const std::string& check) {
    for (const double ratio : ratios) {
      const auto named = [&](const Subject& one) {
        Finding finding =
            one.finding(statement, claim, fmt::format("{}, delta = {:g}h", check, ratio), quantity, Test::rate);
        finding.theory_order = 1.0;
        return finding;
      };
      rows.add(named(subject), [=](Finding& row) { measure(row, subject, ratio); });
      if (subject.scene->standing()) continue;
      const Subject wrong = mistaken(subject, "no divergence term", "no divergence term");
      rows.add_control(
          named(wrong), "without b' u mass follows the volumes", [=](Finding& row) { measure(row, wrong, ratio); },
          Verdict::stagnates);
    }
  };
  if (!scheme.nonlocal_divergence) {
    if (scheme.model == 1) {
      add(subject_on(scheme, scene_with("sin(2*pi*x)")),
          "standing, equal gaps, c of both signs: Model I's drift vanishes with order 1", "c = sin(2 pi x)");
    }
    add(subject_on(scheme, scene_with("1"), Arrangement::jittered),
        "standing, uneven gaps: the drift vanishes with order 1", "c = 1");
    add(subject_on(scheme, scene_with("1 + sin(2*pi*x)/2"), Arrangement::jittered),
        "standing, uneven gaps: the drift vanishes with order 1", "c = 1 + sin(2 pi x)/2");
  }
  add(subject_on(scheme, scene_named("lee-du-2019")), "moving: the drift vanishes with order 1", "scene lee-du-2019");
}

}  // namespace

void add_rows_of_mass(ExtremeRows& rows, const Extremes& extremes) {
  for (const SchemeChoice& scheme : standing_schemes(extremes)) add_conserved(rows, scheme);
  for (const SchemeChoice& scheme : extremes.schemes) add_drifting(rows, scheme);
}

}  // namespace acstudy
