#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "studies/claims/extreme_rows.hpp"
#include "studies/claims/stability.hpp"

namespace acstudy {

namespace {

const std::vector<double> ratios = {1e-3, 0.7, 1.0, 3.5, 15.0};
constexpr std::int64_t N_velocity = 48;

/// Calls `measure(placed, h)` at every horizon and arrangement, and makes what it returns a point.
template <class Measure>
void at_every_horizon(Finding& row, const Subject& subject, Measure&& measure) {
  const double h = subject.scene->period() / static_cast<double>(N_velocity);
  for (const double ratio : ratios) {
    for (const std::vector<double>& x : subject.positions(N_velocity)) {
      PlacedScheme placed(subject.scheme, *subject.scene, subject.mu, x, ratio * h);
      Point point = measure(placed);
      point.N = N_velocity;
      point.h = h;
      point.delta = ratio * h;
      point.variable = ratio;
      row.points.push_back(point);
    }
  }
  row.variable = "delta/h";
}

// --------------------------------------------------------------------------------------------------------------- c = 0

void add_no_velocity(ExtremeRows& rows, const SchemeChoice& scheme, Arrangement arrangement) {
  const auto rest = [](Finding& row, const Subject& subject) {
    at_every_horizon(row, subject, [](PlacedScheme& placed) {
      return Point{.value = max_norm(placed.rate(uneven_values(placed.size()))), .upper = 0.0};
    });
  };
  const auto named = [&](const Subject& subject, const Coordinate& velocity) {
    return subject.check("c = 0", "nothing changes, not by a bit", {velocity}, "max |rate|");
  };
  const Subject still = subject_on(scheme, scene_with("0"), arrangement);
  rows.add(named(still, {"c", "0", "c = 0, mu = max|c| = 0"}), [=](Finding& row) { rest(row, still); });
  const Subject moved = subject_on(scheme, scene_with("1e-12"), arrangement);
  rows.add_control(named(moved, velocity_is("1e-12")), "a velocity, however small",
                   [=](Finding& row) { rest(row, moved); });

  if (!scheme.model->viscous) return;
  Subject viscous = still;
  viscous.mu = 1.0;
  const auto diffusion = [&](double cfl) {
    return viscous.check(
        "c = 0", fmt::format("with mu = 1 {} is a diffusion: a step at CFL 1 has the max norm 1", scheme.model->name),
        {at_cfl(cfl)}, "max norm of I + dt R");
  };
  const auto step = [=](Finding& row, double cfl) {
    row.points = step_is_bounded(viscous, {{N_velocity}, ratios, {}}, StepCondition::corrected, cfl).take().points;
    row.variable = "delta/h";
  };
  rows.add(diffusion(1.0), [=](Finding& row) { step(row, 1.0); });
  rows.add_control(diffusion(1.5), "beyond the condition", [=](Finding& row) { step(row, 1.5); });
}

// ---------------------------------------------------------------------------------------------------------- c constant

/// The rate of u = 1 against the round-off of its terms.
void rate_of_constants(Finding& row, const Subject& subject) {
  at_every_horizon(row, subject, [&](PlacedScheme& placed) {
    const std::vector<double> one(placed.size(), 1.0), rate = placed.rate(one);
    const auto x = placed.particles().x.values();
    const std::vector<double> at(x.begin(), x.end());
    Point worst{.value = 0.0};
    for (std::size_t j = 0; j < rate.size(); ++j) {
      const double relative = std::abs(rate[j]) / subject.printed_rate(at, one, placed.particles().delta, j).size;
      if (worse(relative, worst.value)) worst.value = relative;
    }
    worst.upper = row_round_off(placed.particles());
    return worst;
  });
}

void add_constant_velocity(ExtremeRows& rows, const SchemeChoice& scheme, Arrangement arrangement) {
  const auto constants = [&](const Subject& subject, const Coordinate& velocity) {
    return subject.check("c constant", "constants stay as they are, to round-off", {velocity},
                         "max |rate of u = 1| / sum of |terms|");
  };
  const Subject subject = subject_on(scheme, scene_with("1"), arrangement);
  rows.add(constants(subject, velocity_is("1")), [=](Finding& row) { rate_of_constants(row, subject); });
  const Subject varying = subject_on(scheme, scene_with("1 + sin(2*pi*x)/2"), arrangement);
  rows.add_control(constants(varying, velocity_is("1 + sin(2 pi x)/2")), "u = 1 is not steady where c varies",
                   [=](Finding& row) { rate_of_constants(row, varying); });

  for (const std::string c : {"1", "-1"}) {
    const Subject one = subject_on(scheme, scene_with(c), arrangement);
    const auto norm = [&](double cfl) {
      return one.check("c constant", "maximum principle: a step at CFL 1 has the max norm 1",
                       {velocity_is(c), at_cfl(cfl)}, "max norm of I + dt R");
    };
    const auto step = [one](Finding& row, double cfl) {
      row.points = step_is_bounded(one, {{N_velocity}, ratios, {}}, StepCondition::corrected, cfl).take().points;
      row.variable = "delta/h";
    };
    rows.add(norm(1.0), [=](Finding& row) { step(row, 1.0); });
    if (c == "1") rows.add_control(norm(1.5), "beyond the condition", [=](Finding& row) { step(row, 1.5); });
  }
}

// --------------------------------------------------------------------------------------------------------------- b = c

const std::string lagrangian = "b = c";

/// What the scheme leaves of the equation, against round-off or Lemmas 2.5 and 3.4 for the divergence of b.
void leave_of_equation(Finding& row, const Subject& subject, bool to_round_off) {
  const Scene& scene = *subject.scene;
  const FieldBounds fields = field_bounds(scene, 0.0);
  at_every_horizon(row, subject, [&](PlacedScheme& placed) {
    const auto source = make_source(subject.scheme, scene, subject.mu, false, placed.particles().delta);
    const auto x = placed.particles().x.values();
    const double widest = gaps({x.begin(), x.end()}, scene.period()).largest;
    const double part = subject.scheme.model->divergence_part;
    const double divergence = part * std::max(widest, placed.particles().delta) * fields.b_2 * fields.u;
    // u_t, c u_x and b u_x, c' u and b' u, each with a few roundings; c has at most the norm of b.
    const double round_off = 16.0 * epsilon * (2.0 * fields.u_1 + fields.b_1 * fields.u);
    return Point{.value = max_norm(placed.truncation_error(*source, 0.0)),
                 .upper = round_off + (to_round_off ? 0.0 : divergence)};
  });
}

/// Errors of whole runs with ever shorter steps on the same particles.
void refine_steps(Finding& row, const Subject& subject, std::string_view integrator) {
  const double delta = 2.5 * subject.scene->period() / 16.0;
  for (const std::int64_t steps : {16, 32, 64, 128, 256}) {
    const Case c = case_of(subject, 16, delta, steps, integrator);
    row.points.push_back({.N = c.N, .h = c.h, .delta = delta, .variable = c.dt, .value = run(c).error_linf});
  }
  row.variable = "dt";
}

void add_lagrangian(ExtremeRows& rows, const SchemeChoice& scheme, Arrangement arrangement) {
  const auto scene = scene_named("lagrangian");
  SchemeChoice local = scheme, other = scheme;
  local.nonlocal_divergence = false;
  other.nonlocal_divergence = true;
  const Subject with_local = subject_on(local, scene, arrangement),
                with_nonlocal = subject_on(other, scene, arrangement);

  const auto exact = [&](const Subject& subject) {
    return subject.check(lagrangian, "local divergence: the equation is met to round-off, whatever delta",
                         {on_scene("lagrangian"), {"bound", "to round-off"}}, "max |rate + f - du/dt|");
  };
  rows.add(exact(with_local), [=](Finding& row) { leave_of_equation(row, with_local, true); });
  rows.add_control(exact(with_nonlocal), "its divergence is not exact",
                   [=](Finding& row) { leave_of_equation(row, with_nonlocal, true); });

  const auto consistent = [&](const Subject& subject) {
    return subject.check(lagrangian, "nonlocal divergence: what is left is the consistency error of b'",
                         {on_scene("lagrangian"), {"bound", "to O(max(h, delta))"}}, "max |rate + f - du/dt|");
  };
  rows.add(consistent(with_nonlocal), [=](Finding& row) { leave_of_equation(row, with_nonlocal, false); });
  const Subject without = *mistaken(with_local, "no divergence term");
  rows.add_control(consistent(without), "b' u is missing",
                   [=](Finding& row) { leave_of_equation(row, without, false); });

  if (arrangement != Arrangement::uniform) return;
  for (const std::string integrator : {"forward-euler", "ssprk3"}) {
    const auto time_only = [&](const Subject& subject) {
      Check check = subject.check(lagrangian, "local divergence: the error of a run is that of the time steps",
                                  {{"N", 16.0, "N = 16"}, {"integrator", integrator}}, "max |u - exact|", Test::order);
      check.theory_order = integrator == "ssprk3" ? 3.0 : 1.0;
      return check;
    };
    rows.add(time_only(with_local), [=](Finding& row) { refine_steps(row, with_local, integrator); });
    if (integrator != "ssprk3") continue;
    rows.add_control(
        time_only(with_nonlocal), "the error of b' stays, however short the steps",
        [=](Finding& row) { refine_steps(row, with_nonlocal, integrator); }, Verdict::stagnates);
  }
}

// ----------------------------------------------------------------------------------------------------- zeros of c_hat

const std::string zero = "a particle at a zero of c_hat";

/// The rate of particle 0, at x = 0, against the printed sums of `as`.
void rate_at_zero(Finding& row, const Subject& subject, const Subject& as) {
  at_every_horizon(row, subject, [&](PlacedScheme& placed) {
    const std::vector<double> u = uneven_values(placed.size()), rate = placed.rate(u);
    const auto x = placed.particles().x.values();
    const PrintedRate printed = as.printed_rate({x.begin(), x.end()}, u, placed.particles().delta, 0);
    return Point{.value = std::abs(rate[0] - printed.value) / printed.size,
                 .upper = 2.0 * row_round_off(placed.particles())};
  });
}

/// How many neighbors of particle 0 are on its right, as a share of all.
void side_at_zero(Finding& row, const Subject& subject) {
  at_every_horizon(row, subject, [](PlacedScheme& placed) {
    const Stencil stencil = placed.scheme().stencil(0);
    const auto right = std::count_if(stencil.offset.begin(), stencil.offset.end(), [](auto k) { return k > 0; });
    return Point{
        .value = static_cast<double>(right) / static_cast<double>(stencil.offset.size()), .lower = 1.0, .upper = 1.0};
  });
}

void add_zero_of_velocity(ExtremeRows& rows, const SchemeChoice& scheme) {
  struct Fields {
    std::string c;
    std::optional<std::string> b;
  };
  // c_hat(0) is 0, -0, and 0 as the difference of equal velocities; it rises, falls, and rises.
  std::vector<Fields> cases = {{"1 + sin(2*pi*x)", "1 + sin(2*pi*x)/2"}};
  if (!scheme.nonlocal_divergence) {
    cases.push_back({"sin(2*pi*x)", std::nullopt});
    cases.push_back({"-sin(2*pi*x)", std::nullopt});
  }
  for (const Fields& fields : cases) {
    const Subject subject = subject_on(scheme, scene_with(fields.c, fields.b));
    const auto conditions = [&](const std::string& c) {
      std::vector<Coordinate> all = {velocity_is(c)};
      if (fields.b) all.emplace_back("b", *fields.b, "b = " + *fields.b);
      all.emplace_back("x_0", 0.0, "x_0 = 0");
      return all;
    };
    const auto named = [&](const Subject& one) {
      return one.check(zero, "its rate is what the formula gives", conditions(fields.c),
                       "|rate_0 - printed sum| / sum of |terms|");
    };
    rows.add(named(subject), [=](Finding& row) { rate_at_zero(row, subject, subject); });
    if (const auto wrong = mistaken(subject, scheme.model->mistakes.not_monotone)) {
      rows.add_control(named(*wrong), "a scheme with a mistake",
                       [=](Finding& row) { rate_at_zero(row, *wrong, subject); });
    }
    if (!scheme.model->upwind) continue;
    const auto side = [&](const Subject& one, const std::string& c) {
      std::vector<Coordinate> all = conditions(c);
      all.emplace_back("of", "side");
      return one.check(zero, fmt::format("{} looks right where c_hat is zero", scheme.model->name), all,
                       "share of neighbors on the right");
    };
    rows.add(side(subject, fields.c), [=](Finding& row) { side_at_zero(row, subject); });
    if (fields.b) continue;
    const std::string positive = "1e-300 + abs(" + fields.c + ")";
    const Subject left = subject_on(scheme, scene_with(positive));
    rows.add_control(side(left, positive), "c_hat is positive, if only just",
                     [=](Finding& row) { side_at_zero(row, left); });
  }
}

}  // namespace

void add_rows_of_velocity(ExtremeRows& rows, const Extremes& extremes) {
  for (const Arrangement arrangement : {Arrangement::uniform, Arrangement::jittered}) {
    for (const SchemeChoice& scheme : standing_schemes(extremes)) add_no_velocity(rows, scheme, arrangement);
  }
  for (const Arrangement arrangement : {Arrangement::uniform, Arrangement::jittered}) {
    for (const SchemeChoice& scheme : standing_schemes(extremes)) add_constant_velocity(rows, scheme, arrangement);
  }
  for (const Arrangement arrangement : {Arrangement::uniform, Arrangement::jittered}) {
    for (const SchemeChoice& scheme : standing_schemes(extremes)) add_lagrangian(rows, scheme, arrangement);
  }
  for (const SchemeChoice& scheme : extremes.schemes) add_zero_of_velocity(rows, scheme);
}

}  // namespace acstudy
