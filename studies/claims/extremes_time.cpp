#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/claims/extreme_rows.hpp"

namespace acstudy {

namespace {

/// The paper's scene to another time.
std::shared_ptr<const Scene> paper_to(const std::string& T) {
  SceneText text = scene_named("lee-du-2019")->text();
  text.name.clear();
  text.T = T;
  return std::make_shared<const Scene>(text);
}

// --------------------------------------------------------------------------------------------------------------- T = 0

void add_no_time(ExtremeRows& rows, const SchemeChoice& scheme) {
  const auto end_at_start = [scheme](Finding& row, const std::string& T) {
    const Subject subject = subject_on(scheme, paper_to(T));
    const double h = subject.scene->period() / 32.0;
    const Case c = case_of(subject, 32, 3.5 * h, steps_for(subject.scene->T(), 0.25 * h));
    const CaseResult result = run(c);
    const std::vector<double> x = uniform_positions(32, subject.scene->period());
    std::vector<double> changed(32);
    subject.scene->u(x, 0.0, changed);
    for (std::size_t j = 0; j < changed.size(); ++j) changed[j] -= result.u[j];
    const auto add = [&](const std::string& what, double value) {
      row.points.push_back({.N = 32, .h = h, .delta = 3.5 * h, .value = value, .upper = 0.0, .label = what});
    };
    add("steps", static_cast<double>(c.steps));
    add("dt", c.dt);
    add("max |u(T) - u(0)|", max_norm(changed));
    add("max error", result.error_linf);
    add("L1 error", result.error_l1);
    add("L2 error", result.error_l2);
  };
  const auto named = [&](const std::string& T) {
    return subject_on(scheme, paper_to("0"))
        .check("T = 0", "no step is taken, and the initial values come back without an error", {{"T", T, "T = " + T}},
               "steps, dt, change, errors");
  };
  rows.add(named("0"), [=](Finding& row) { end_at_start(row, "0"); });
  rows.add_control(named("1e-9"), "a time, however short", [=](Finding& row) { end_at_start(row, "1e-9"); });
}

// ------------------------------------------------------------------------------------------------------------ one step

/// u(T) of a run in so many steps against one step by hand, u_0 + T (rate + f).
void step_by_hand(Finding& row, const SchemeChoice& scheme, std::int64_t times) {
  for (const std::string T : {"1/100", "1/20"}) {
    const Subject subject = subject_on(scheme, paper_to(T));
    const Scene& scene = *subject.scene;
    for (const double ratio : {0.5, 3.5}) {
      const double h = scene.period() / 32.0, delta = ratio * h;
      const CaseResult result = run(case_of(subject, 32, delta, times * steps_for(scene.T(), 10.0 * scene.T())));
      const std::vector<double> x = uniform_positions(32, scene.period());
      const std::vector<double> u = values_at(x, [](double y) { return std::cos(y); });
      Point worst{.N = 32, .h = h, .delta = delta, .variable = ratio, .value = 0.0};
      for (std::size_t j = 0; j < x.size(); ++j) {
        const PrintedRate rate = subject.printed_rate(x, u, delta, j);
        // f = u_t + c u_x + c' u with u = cos(x - t), c = cos(2x)/3 at t = 0
        const double f = std::sin(x[j]) - std::cos(2.0 * x[j]) / 3.0 * std::sin(x[j]) -
                         2.0 / 3.0 * std::sin(2.0 * x[j]) * std::cos(x[j]);
        const double by_hand = u[j] + scene.T() * (rate.value + f);
        const double size = 1.0 + scene.T() * (rate.size + 2.0);
        const double off = std::abs(result.u[j] - by_hand) / size;
        if (worse(off, worst.value)) worst.value = off;
      }
      worst.upper = 2.0 * (2.0 * ratio + 10.0) * epsilon;
      worst.label = "T = " + T;
      row.points.push_back(worst);
    }
  }
  row.variable = "delta/h";
}

void add_one_step(ExtremeRows& rows, const SchemeChoice& scheme) {
  const auto named = [&](const std::string& steps) {
    return subject_on(scheme, paper_to("1/100"))
        .check("one step", "u(T) = u(0) + T (rate + f), where the step is longer than T", {{"steps", steps}},
               "max |u(T) - by hand| / sum of |terms|");
  };
  rows.add(named("step = 10 T"), [=](Finding& row) { step_by_hand(row, scheme, 1); });
  rows.add_control(named("two steps"), "two steps are not one", [=](Finding& row) { step_by_hand(row, scheme, 2); });
}

// ------------------------------------------------------------------------------------------------------------------
// CFL

const std::string cfl_numbers = "CFL 1, 1.01, 2";

/// The norm of a step. c = 1, equal gaps: nu = dt sum W_k is CFL, the row of I + dt R has 1 - nu on its diagonal and nu
/// off it: in an upwind model whatever delta, in others below the gap, where with mu = c all are the upwind difference.
void predict_norm(Finding& row, const Subject& subject, const std::vector<double>& ratios,
                  const std::vector<double>& cfls, bool stable) {
  const double h = 1.0 / 64.0;
  const std::vector<double> x = uniform_positions(64, 1.0);
  for (const double ratio : ratios) {
    PlacedScheme placed(subject.scheme, *subject.scene, subject.mu, x, ratio * h);
    const double largest = step_at_cfl_one(subject, x, ratio * h);
    for (const double nu : cfls) {
      const double predicted = stable ? 1.0 : std::abs(1.0 - nu) + nu;
      const double round_off = predicted * step_round_off(subject, placed.particles());
      row.points.push_back({.N = 64,
                            .h = h,
                            .delta = ratio * h,
                            .variable = nu,
                            .value = step_norm(placed, nu * largest),
                            .lower = predicted - round_off,
                            .upper = predicted + round_off,
                            .label = fmt::format("CFL {:g}", nu)});
    }
  }
  row.variable = "CFL";
}

/// Below the gap (-1)^j is multiplied by 1 - 2 CFL in each step.
void predict_growth(Finding& row, const Subject& subject, bool sawtooth) {
  const double h = 1.0 / 64.0;
  const std::vector<double> x = uniform_positions(64, 1.0);
  std::vector<double> u(64, 1.0);
  for (std::size_t j = 1; sawtooth && j < u.size(); j += 2) u[j] = -1.0;
  const double largest = step_at_cfl_one(subject, x, 0.5 * h);
  for (const double nu : {1.0, 1.01, 2.0}) {
    double farthest = 0.0, predicted = 1.0;
    const std::int64_t steps = 40;
    const double dt = nu * largest;
    run_freely(subject, {x, u}, 0.5 * h, static_cast<double>(steps) * dt, steps,
               [&](const TimeStep&, std::span<const double>, std::span<const double> values) {
                 predicted *= std::abs(1.0 - 2.0 * nu);
                 const double off = std::abs(max_norm({values.begin(), values.end()}) / predicted - 1.0);
                 if (worse(off, farthest)) farthest = off;
               });
    row.points.push_back({.N = 64,
                          .h = h,
                          .delta = 0.5 * h,
                          .variable = nu,
                          .value = farthest,
                          // An error of a step grows no faster than the mode, but where the mode does not grow.
                          .upper = 16.0 * static_cast<double>(steps) * epsilon,
                          .label = fmt::format("CFL {:g}", nu)});
  }
  row.variable = "CFL";
}

void add_cfl(ExtremeRows& rows, const SchemeChoice& scheme) {
  const Subject subject = subject_on(scheme, scene_with("1"));
  const std::vector<double> ratios = scheme.model->upwind ? std::vector<double>{0.5, 3.5} : std::vector<double>{0.5};
  const Coordinate horizon =
      scheme.model->upwind ? Coordinate("delta/h", "0.5 and 3.5", "delta = 0.5h, 3.5h") : at_ratio(0.5);
  const Check norm =
      subject.check(cfl_numbers, "c constant, equal gaps: the norm of a step is |1 - CFL| + CFL: 1, 1.02, 3", {horizon},
                    "max norm of I + dt R");
  rows.add(norm, [=](Finding& row) { predict_norm(row, subject, ratios, {1.0, 1.01, 2.0}, false); });
  Check stable = norm;
  stable.coordinates.emplace_back("asked", "a norm of 1");
  rows.add_control(stable, "beyond CFL 1 it is larger", [=](Finding& row) {
    predict_norm(row, subject, ratios, {1.01, 2.0}, true);
  });

  const auto growth = [&](const std::string& mode) {
    return subject.check(cfl_numbers, "c constant, delta = h/2: (-1)^j grows like |1 - 2 CFL|^n: by 1, 1.02, 3 a step",
                         {{"mode", mode, "40 steps from " + mode}}, "max over n of |max |u^n| / |1 - 2 CFL|^n - 1|");
  };
  rows.add(growth("(-1)^j"), [=](Finding& row) { predict_growth(row, subject, true); });
  rows.add_control(growth("1"), "constants do not grow", [=](Finding& row) { predict_growth(row, subject, false); });
}

// ----------------------------------------------------------------------------------------------------------- many
// steps

/// What is followed over many steps.
enum class Followed { constant, range, sum };

/// 16 uniform particles, CFL 1/2. Each step rounds with a few ulps, and is a convex combination of values where c is
/// constant; where c varies its matrix has no negative entries and columns that sum to one.
void step_often(Finding& row, const Subject& subject, Followed followed, std::int64_t steps) {
  const double h = 1.0 / 16.0, delta = 2.5 * h;
  const std::vector<double> x = uniform_positions(16, 1.0);
  const std::vector<double> u = followed == Followed::constant ? std::vector<double>(16, 1.0) : uneven_values(16);
  const auto sum_of = [](std::span<const double> values) {
    double sum = 0.0;
    for (const double value : values) sum += std::abs(value);
    return sum;
  };
  const double start = sum_of(u), dt = 0.5 * step_at_cfl_one(subject, x, delta);
  double farthest = 0.0;
  run_freely(subject, {x, u}, delta, static_cast<double>(steps) * dt, steps,
             [&](const TimeStep&, std::span<const double>, std::span<const double> values) {
               const double out = followed == Followed::constant ? excursion(values, 1.0, 1.0)
                                  : followed == Followed::range  ? excursion(values, 0.0, 1.0)
                                                                 : std::abs(sum_of(values) / start - 1.0);
               if (worse(out, farthest)) farthest = out;
             });
  Particles particles(16, 1.0, delta);
  particles.place(x);
  row.points.push_back({.N = 16,
                        .h = h,
                        .delta = delta,
                        .value = farthest,
                        .upper = static_cast<double>(steps) * step_round_off(subject, particles)});
}

void add_many_steps(ExtremeRows& rows, const SchemeChoice& scheme, std::int64_t most) {
  const auto scene = scene_with("1"), varying = scene_with("1 + sin(2*pi*x)/2");
  const std::string statement = fmt::format("{} steps", most);
  const std::int64_t fewer = std::min<std::int64_t>(most, 1000);
  const std::string_view mistake = scheme.model->mistakes.not_monotone;
  const auto add = [&](const std::string& claim, const std::string& quantity, const std::string& followed_as,
                       Followed followed, const Subject& right, const std::optional<Subject>& wrong,
                       const std::string& why) {
    std::vector<Coordinate> conditions = {{"N", 16.0, "N = 16"}, {"of", followed_as}};
    rows.add(right.check(statement, claim, conditions, quantity),
             [=](Finding& row) { step_often(row, right, followed, most); });
    if (!wrong) return;
    conditions.emplace_back("steps", static_cast<double>(fewer), fmt::format("{} steps", fewer));
    rows.add_control(wrong->check(statement, claim, conditions, quantity), why,
                     [=](Finding& row) { step_often(row, *wrong, followed, fewer); });
  };
  const Subject steady = subject_on(scheme, scene), uneven = subject_on(scheme, varying);
  add("c constant: constants drift by round-off alone", "max |u - 1|", "u = 1", Followed::constant, steady, uneven,
      "constants are not steady where c varies");
  add("c constant: values stay between the initial ones", "largest excursion", "range", Followed::range, steady,
      mistaken(steady, mistake), "a scheme that is not stable");
  add("c > 0 varying, equal gaps: sum |u_j| stays, for positive u", "max |sum |u_j| / its start - 1|", "sum",
      Followed::sum, uneven, mistaken(uneven, mistake), "a scheme that is not positive");
}

void add_time_levels(ExtremeRows& rows, std::int64_t most) {
  const auto named = [&](const std::string& by) {
    return Check{.statement = fmt::format("{} steps", most),
                 .claim = "time levels are n T/count to the last rounding, and the last one is T",
                 .subject = "time levels",
                 .coordinates = {{"by", by}},
                 .quantity = "max |t^n - n T/count| / (t^n eps)"};
  };
  const auto compare = [most](Finding& row, bool summed) {
    for (const double T : {1.0, 1.0 / 3.0, 0.1}) {
      EqualSteps times(T, most);
      double farthest = 0.0, sum = 0.0, before = 0.0;
      for (std::int64_t n = 1; const auto step = times.next(); ++n) {
        sum += T / static_cast<double>(most);
        const double t = summed ? sum : step->end;
        const long double exact = static_cast<long double>(n) * T / static_cast<long double>(most);
        // A step begins where the last one has ended.
        const double gap = step->begin == before ? 0.0 : NAN;
        const double off = static_cast<double>(std::abs(t - exact) / exact) / epsilon + gap;
        if (worse(off, farthest)) farthest = off;
        before = step->end;
      }
      if (before != T) farthest = NAN;
      // Two roundings of half an ulp, that of T/count and that of the product.
      row.points.push_back({.N = most, .variable = T, .value = farthest, .upper = 1.001});
    }
    row.variable = "T";
  };
  rows.add(named("t = n T/count"), [=](Finding& row) { compare(row, false); });
  rows.add_control(named("time summed up"), "roundings of a sum add up", [=](Finding& row) { compare(row, true); });
}

}  // namespace

void add_rows_of_time(ExtremeRows& rows, const Extremes& extremes) {
  for (const SchemeChoice& scheme : extremes.schemes) add_no_time(rows, scheme);
  for (const SchemeChoice& scheme : extremes.schemes) add_one_step(rows, scheme);
  for (const SchemeChoice& scheme : standing_schemes(extremes)) add_cfl(rows, scheme);
  for (const SchemeChoice& scheme : standing_schemes(extremes)) add_many_steps(rows, scheme, extremes.most_steps);
  add_time_levels(rows, extremes.most_steps);
}

}  // namespace acstudy
