#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "studies/claims/extreme_rows.hpp"
#include "studies/claims/identities.hpp"
#include "studies/claims/stability.hpp"

namespace acstudy {

namespace {

/// A measurement of another kind of study as a row of the table.
void adopt(Finding& row, const Measurement& measurement) {
  const Finding measured = measurement.take();
  row.failure = measured.failure;
  row.points.insert(row.points.end(), measured.points.begin(), measured.points.end());
  row.variable = measured.variable;
}

double largest_horizon(const Scene& scene) { return std::nextafter(0.5 * scene.period(), 0.0); }

// ------------------------------------------------------------------------------------------------- number of particles

constexpr std::int64_t few[] = {3, 4, 5, 7};
std::string numbers(std::int64_t most) { return fmt::format("N = 3 to {}", most); }

void add_few_particles(ExtremeRows& rows, const SchemeChoice& scheme, std::int64_t most) {
  const Subject subject = subject_on(scheme, scene_with("1"));
  const Resolutions resolutions{{std::begin(few), std::end(few)}, {0.3, 1.0, 1.3}, {largest_horizon(*subject.scene)}};
  const auto named = [&](double cfl) {
    return subject.check(numbers(most), "N = 3, 4, 5, 7, c constant: a step at CFL 1 has the max norm 1",
                         {{"N", "3 to 7", "N = 3 to 7"}, at_cfl(cfl)}, "max norm of I + dt R");
  };
  rows.add(named(1.0),
           [=](Finding& row) { adopt(row, step_is_bounded(subject, resolutions, StepCondition::corrected)); });
  rows.add_control(named(1.5), "beyond the condition", [=](Finding& row) {
    adopt(row, step_is_bounded(subject, resolutions, StepCondition::corrected, 1.5));
  });
}

/// A run without source on N = 3, 4, 5, 7 moving particles.
void run_few(Finding& row, const Subject& subject, double cfl) {
  const Scene& scene = *subject.scene;
  const FieldBounds fields = field_bounds(scene, 0.0);
  const double growth = fields.c_hat_1 + fields.b_1;
  for (const std::int64_t N : few) {
    const std::vector<double> x = subject.positions(N).front(), u = uneven_values(x.size());
    const double h = scene.period() / static_cast<double>(N);
    for (const double ratio : {0.3, 1.3}) {
      const double dt = cfl * step_at_cfl_one(subject, x, ratio * h);
      // The gaps of the paper's scene close by the factor e, which takes steps e times as short.
      const std::int64_t steps = growth > 0.01 ? steps_for(scene.T(), dt / 8.0) : 20;
      const double T = growth > 0.01 ? scene.T() : 20.0 * dt;
      const State end = run_freely(subject, {x, u}, ratio * h, T, steps);
      row.points.push_back({.N = N,
                            .h = h,
                            .delta = ratio * h,
                            .variable = ratio,
                            .value = max_norm(end.u),
                            .upper = std::exp(growth * T) * (1.0 + static_cast<double>(steps) * 4.0 *
                                                                       static_cast<double>(2 * N + 8) * epsilon)});
    }
  }
  row.variable = "delta/h";
}

void add_few_moving_particles(ExtremeRows& rows, const SchemeChoice& scheme, std::int64_t most) {
  const Subject carried = subject_on(scheme, scene_with("1", "1/2"));
  const Subject paper = subject_on(scheme, scene_named("lee-du-2019"));
  const auto named = [most](const Subject& subject, const std::vector<Coordinate>& conditions) {
    return subject.check(numbers(most), "N = 3, 4, 5, 7, moving: max |u| grows by at most exp(T (||c_hat'|| + ||b'||))",
                         conditions, "max |u(T)| / max |u(0)|");
  };
  const Coordinate half = {"b", "1/2", "b = 1/2"};
  rows.add(named(carried, {velocity_is("1"), half, at_cfl(1.0)}), [=](Finding& row) { run_few(row, carried, 1.0); });
  rows.add(named(paper, {on_scene("lee-du-2019")}), [=](Finding& row) { run_few(row, paper, 1.0); });
  rows.add_control(named(carried, {velocity_is("1"), half, at_cfl(1.5)}), "beyond the condition",
                   [=](Finding& row) { run_few(row, carried, 1.5); });
}

/// Errors of ten steps from u = sin(2 pi x), c = 1, against ten truncation errors.
void take_ten_steps(Finding& row, const Subject& subject, std::int64_t N) {
  const double h = 1.0 / static_cast<double>(N), delta = 1.45 * h;
  const std::vector<double> x = uniform_positions(static_cast<std::size_t>(N), 1.0);
  const FieldBounds fields = field_bounds(*subject.scene, 0.0);
  std::vector<double> u(x.size()), exact(x.size());
  subject.scene->u(x, 0.0, u);
  const std::int64_t steps = 10;
  const double dt = h / 4.0, T = static_cast<double>(steps) * dt;
  const State end = run_freely(subject, {x, u}, delta, T, steps);
  subject.scene->u(x, T, exact);
  for (std::size_t j = 0; j < x.size(); ++j) exact[j] -= end.u[j];
  // The lemma against the PDE, and (u_t + u_x) of forward Euler. A weight errs by an ulp of a position over a gap.
  const double space = std::max(h, delta) * subject.scheme.model->pde_constant * fields.u_2;
  const double round_off = 16.0 * epsilon + 4.0 * dt * fields.u_1 * epsilon / h;
  row.points.push_back({.N = N,
                        .h = h,
                        .delta = delta,
                        .variable = h,
                        .value = max_norm(exact),
                        .upper = static_cast<double>(steps) * (dt * (space + 0.5 * dt * fields.u_2) + round_off)});
}

void add_many_particles(ExtremeRows& rows, const SchemeChoice& scheme, std::int64_t most) {
  const Subject subject = subject_on(scheme, scene_with("1"));
  const std::int64_t fewer = std::min<std::int64_t>(most, 10'000);
  const auto norm_of = [&](double cfl) {
    return subject.check(numbers(most), fmt::format("N = {}, c constant: a step at CFL 1 has the max norm 1", most),
                         {at_ratio(1.45), at_cfl(cfl)}, "max norm of I + dt R");
  };
  const auto norm = [subject](Finding& row, std::int64_t N, double cfl) {
    adopt(row, step_is_bounded(subject, {{N}, {1.45}, {}}, StepCondition::corrected, cfl));
  };
  rows.add(norm_of(1.0), [=](Finding& row) { norm(row, most, 1.0); });
  rows.add_control(norm_of(1.5), "beyond the condition", [=](Finding& row) { norm(row, fewer, 1.5); });

  const auto steps_of = [&](const Subject& one) {
    return one.check(numbers(most), fmt::format("N = {}: ten steps are off by at most ten truncation errors", most),
                     {at_ratio(1.45), {"cfl", 0.25, "CFL 1/4"}}, "max |u - exact|");
  };
  rows.add(steps_of(subject), [=](Finding& row) { take_ten_steps(row, subject, most); });
  if (const auto wrong = mistaken(subject, scheme.model->mistakes.inconsistent)) {
    rows.add_control(steps_of(*wrong), "a scheme that is not consistent",
                     [=](Finding& row) { take_ten_steps(row, *wrong, fewer); });
  }
}

// ------------------------------------------------------------------------------------------------------------- delta/h

const std::string horizons = "delta/h = 1e-12 to period/2";
const std::vector<double> below_every_gap = {1e-12, 1e-9, 1e-6, 1e-3, 0.5};

/// Rates with the horizons ratio h_min against those with 0.9 h_min.
void compare_rates_below(Finding& row, const Subject& subject, const std::vector<double>& ratios) {
  const Scene& scene = *subject.scene;
  for (const std::vector<double>& x : subject.positions(48)) {
    const Gaps gap = gaps(x, scene.period());
    std::vector<double> u(x.size());
    scene.u(x, 0.0, u);
    PlacedScheme reference(subject.scheme, scene, subject.mu, x, 0.9 * gap.smallest);
    const std::vector<double> expected = reference.rate(u);
    for (const double ratio : ratios) {
      PlacedScheme placed(subject.scheme, scene, subject.mu, x, ratio * gap.smallest);
      const std::vector<double> rate = placed.rate(u);
      Point point{.N = 48, .h = gap.largest, .delta = ratio * gap.smallest, .variable = ratio, .value = 0.0};
      for (std::size_t j = 0; j < x.size(); ++j) {
        const double off = std::abs(rate[j] - expected[j]) / subject.printed_rate(x, u, gap.smallest * 0.9, j).size;
        if (worse(off, point.value)) point.value = off;
      }
      point.upper = subject.scheme.model->nearest.bit_by_bit ? 0.0 : 2.0 * row_round_off(placed.particles());
      row.points.push_back(point);
    }
  }
  row.variable = "delta/h_min";
}

void add_below_every_gap(ExtremeRows& rows, const SchemeChoice& scheme, Arrangement arrangement) {
  const Subject subject = subject_on(scheme, scene_named("lee-du-2019"), arrangement);
  const Coordinate below = {"delta/h_min", "1e-12 to 1/2", "delta = 1e-12 to 1/2 h_min"},
                   above = {"delta/h_min", 4.0, "delta = 4 h_min"};
  const auto same = [&](const Coordinate& horizon) {
    return subject.check(horizons,
                         scheme.model->nearest.bit_by_bit
                             ? "below every gap the rates are the same, bit by bit, whatever delta"
                             : "below every gap the rates are the same to round-off, whatever delta",
                         {{"of", "rates"}, horizon}, "max |rate - rate at 0.9 h_min| / sum of |terms|");
  };
  rows.add(same(below), [=](Finding& row) { compare_rates_below(row, subject, below_every_gap); });
  rows.add_control(same(above), "farther neighbors count",
                   [=](Finding& row) { compare_rates_below(row, subject, {4.0}); });

  const auto difference = [&](const Coordinate& horizon) {
    return subject.check(horizons,
                         fmt::format("below every gap {} is {}", scheme.model->name, scheme.model->nearest.in_words),
                         {{"of", "matrix"}, horizon}, "max |row - that of the difference| h_min / max|c_hat|");
  };
  rows.add(difference(below), [=](Finding& row) {
    for (const double ratio : below_every_gap) adopt(row, nearest_neighbor_rows(subject, {48}, ratio));
  });
  rows.add_control(difference(above), "farther neighbors count",
                   [=](Finding& row) { adopt(row, nearest_neighbor_rows(subject, {48}, 4.0)); });
}

void add_refused_horizons(ExtremeRows& rows) {
  const auto take = [](Finding& row, const std::vector<double>& deltas) {
    for (const double delta : deltas) {
      const double value = refused<std::invalid_argument>([&] { Particles(16, 1.0, delta); }, "horizon");
      row.points.push_back({.N = 16, .delta = delta, .variable = delta, .value = value, .lower = 1.0, .upper = 1.0});
    }
    row.variable = "delta";
  };
  const auto named = [](const std::string& interval) {
    return Check{.statement = horizons,
                 .claim = "half the period and more, 0 and less are refused",
                 .subject = "particles",
                 .coordinates = {{"delta", interval}},
                 .quantity = "1 if refused"};
  };
  rows.add(named("not between 0 and period/2"), [=](Finding& row) {
    const double inf = std::numeric_limits<double>::infinity();
    take(row, {0.5, std::nextafter(0.5, 1.0), 1.0, inf, std::nan(""), 0.0, -0.1});
  });
  rows.add_control(named("between 0 and period/2"), "these are horizons", [=](Finding& row) {
    take(row, {std::nextafter(0.5, 0.0), std::numeric_limits<double>::denorm_min()});
  });
}

void add_largest_horizon(ExtremeRows& rows, const SchemeChoice& scheme, Arrangement arrangement) {
  const Subject subject = subject_on(scheme, scene_with("1"), arrangement);
  // An odd number: no particle stands where the largest horizon ends.
  const Resolutions resolutions{{63}, {}, {largest_horizon(*subject.scene)}};
  const Coordinate largest = {"delta", "just below period/2", "delta just below period/2"};

  const auto moment = [&](const Subject& one) {
    return one.check(horizons, fmt::format("at the largest, {}", scheme.model->weights.first_moment_claim),
                     {largest, {"of", "first moment"}}, "max |sum - 1|");
  };
  rows.add(moment(subject), [=](Finding& row) { adopt(row, first_moment_is_one(subject, resolutions)); });
  if (const auto wrong = mistaken(subject, scheme.model->mistakes.inconsistent)) {
    rows.add_control(moment(*wrong), "a part of the kernel is missing",
                     [=](Finding& row) { adopt(row, first_moment_is_one(*wrong, resolutions)); });
  }

  const auto norm = [&](double cfl) {
    return subject.check(horizons, "at the largest, c constant: a step at CFL 1 has the max norm 1",
                         {largest, at_cfl(cfl)}, "max norm of I + dt R");
  };
  const auto step = [=](Finding& row, double cfl) {
    adopt(row, step_is_bounded(subject, resolutions, StepCondition::corrected, cfl));
  };
  rows.add(norm(1.0), [=](Finding& row) { step(row, 1.0); });
  rows.add_control(norm(1.5), "beyond the condition", [=](Finding& row) { step(row, 1.5); });
}

// --------------------------------------------------------------------------------------------------------------- alpha

const std::string exponents = "alpha -> 2";

/// With alpha = 2 - e, W_1 = (d_1/delta)^e / d_1, and the slopes of the flux over d_1 .. d_L differ by at most ||g_xx||
/// delta/2, those of b by ||b_xx|| delta/2: the distance to the upwind difference is at most e log(delta/d_1) times
/// that.
void approach_upwind(Finding& row, const Subject& subject, bool upwind) {
  const Scene& scene = *subject.scene;
  constexpr std::int64_t N = 64;
  const std::vector<double> x = subject.positions(N).front();
  const double h = scene.period() / N, delta = 4.5 * h;
  const FieldBounds fields = field_bounds(scene, 0.0);
  std::vector<double> u(x.size());
  scene.u(x, 0.0, u);
  // The central difference of Model II with any kernel below every gap, or the upwind one of Model I.
  Subject nearest = subject;
  if (!upwind)
    nearest = {{.model = &model_two, .nonlocal_divergence = false, .kernel = integrable_kernel()},
               0.0,
               subject.scene,
               subject.arrangement};
  PlacedScheme limit(nearest.scheme, scene, nearest.mu, x, 0.5 * h);
  const std::vector<double> expected = limit.rate(u);
  for (const double alpha : {1.9, 1.99, 1.999, 1.999999}) {
    Subject close = subject;
    close.scheme.kernel.parameter = alpha;
    PlacedScheme placed(close.scheme, scene, close.mu, x, delta);
    std::vector<double> off = placed.rate(u);
    for (std::size_t j = 0; j < off.size(); ++j) off[j] -= expected[j];
    row.points.push_back(
        {.N = N,
         .h = h,
         .delta = delta,
         .variable = 2.0 - alpha,
         .value = max_norm(off),
         .upper = (2.0 - alpha) * std::log(delta / h) * 0.5 * delta * (fields.flux_2 + fields.b_2 * fields.u) +
                  64.0 * epsilon * (fields.c_hat + fields.b_1) * fields.u / h});
  }
  row.variable = "2 - alpha";
}

void add_singular_kernels(ExtremeRows& rows, const SchemeChoice& scheme) {
  const Subject subject = subject_on(scheme, scene_named("lee-du-2019"));
  const auto named = [&](const std::string& claim, Test test, const std::string& to) {
    std::vector<Coordinate> conditions = {at_ratio(4.5), {"alpha", "1.9 to 1.999999", "alpha = 1.9 to 1.999999"}};
    if (test == Test::bounds) conditions.emplace_back("test", "bound");
    conditions.emplace_back("to", to, to + " difference");
    Check check =
        subject.check(exponents, claim, conditions, fmt::format("max |rate - that of the {} difference|", to), test);
    check.subject.replace(check.subject.rfind(scheme.kernel.name), std::string::npos, scheme.kernel.name + "(alpha)");
    check.theory_order = 1.0;
    return check;
  };
  const std::string to_upwind = fmt::format("{} goes to the upwind difference like 2 - alpha", scheme.model->name);
  rows.add(named(to_upwind, Test::order, "upwind"), [=](Finding& row) { approach_upwind(row, subject, true); });
  rows.add_control(
      named(to_upwind, Test::order, "central"), "it does not go to the central difference",
      [=](Finding& row) { approach_upwind(row, subject, false); }, Verdict::stagnates);
  const std::string within = "within (2 - alpha) log(delta/h) delta (||g_xx|| + ||b''|| ||u||) / 2 of it";
  rows.add(named(within, Test::bounds, "upwind"), [=](Finding& row) { approach_upwind(row, subject, true); });
  rows.add_control(named(within, Test::bounds, "central"), "it does not go to the central difference",
                   [=](Finding& row) { approach_upwind(row, subject, false); });
}

}  // namespace

void add_rows_of_resolution(ExtremeRows& rows, const Extremes& extremes) {
  for (const SchemeChoice& scheme : standing_schemes(extremes))
    add_few_particles(rows, scheme, extremes.most_particles);
  for (const SchemeChoice& scheme : extremes.schemes) add_few_moving_particles(rows, scheme, extremes.most_particles);
  for (const SchemeChoice& scheme : standing_schemes(extremes))
    add_many_particles(rows, scheme, extremes.most_particles);

  for (const Arrangement arrangement : {Arrangement::uniform, Arrangement::jittered}) {
    for (const SchemeChoice& scheme : extremes.schemes) add_below_every_gap(rows, scheme, arrangement);
  }
  add_refused_horizons(rows);
  for (const Arrangement arrangement : {Arrangement::uniform, Arrangement::jittered}) {
    for (const SchemeChoice& scheme : standing_schemes(extremes)) add_largest_horizon(rows, scheme, arrangement);
  }
  // Once a divergence, whatever alpha the study gives.
  for (const bool nonlocal : {false, true}) {
    const auto singular = std::find_if(extremes.schemes.begin(), extremes.schemes.end(), [&](const SchemeChoice& one) {
      const KernelParameter* const parameter = one.kernel.family();
      return one.model->upwind && parameter != nullptr && parameter->singular_at_two &&
             one.nonlocal_divergence == nonlocal;
    });
    if (singular != extremes.schemes.end()) add_singular_kernels(rows, *singular);
  }
}

}  // namespace acstudy
