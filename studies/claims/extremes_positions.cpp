#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "studies/claims/extreme_rows.hpp"
#include "studies/claims/stability.hpp"

namespace acstudy {

namespace {

const std::string coincident = "coincident particles";
constexpr std::size_t N_positions = 16;

struct Placement {
  std::string name;
  std::vector<double> x;
};

/// Positions that are none: two in one place, out of order, around the period, not a number.
std::vector<Placement> refused_placements() {
  std::vector<Placement> all;
  const auto add = [&](const std::string& name, std::size_t j, double position) {
    all.push_back({name, uniform_positions(N_positions, 1.0)});
    all.back().x[j] = position;
  };
  const std::vector<double> x = uniform_positions(N_positions, 1.0);
  add("x_5 = x_4", 5, x[4]);
  add("x_5 an ulp below x_4", 5, std::nextafter(x[4], 0.0));
  add("x_5 beyond x_6", 5, x[6] + 0.01);
  add("x_15 = x_0 + period", N_positions - 1, 1.0);
  add("x_15 beyond x_0 + period", N_positions - 1, 1.1);
  add("x_5 not a number", 5, std::nan(""));
  return all;
}

/// Positions with a smallest gap of an ulp.
std::vector<Placement> nearest_placements() {
  std::vector<Placement> all = {{"x_5 an ulp above x_4", uniform_positions(N_positions, 1.0)},
                                {"x_15 an ulp below x_0 + period", uniform_positions(N_positions, 1.0)}};
  all[0].x[5] = std::nextafter(all[0].x[4], 1.0);
  all[1].x[N_positions - 1] = std::nextafter(1.0, 0.0);
  return all;
}

void add_refusals(ExtremeRows& rows) {
  const auto place = [](Finding& row, const std::vector<Placement>& placements) {
    for (const Placement& placement : placements) {
      Particles particles(N_positions, 1.0, 0.2);
      const double value = refused<std::domain_error>([&] { particles.place(placement.x); }, "particles have crossed");
      row.points.push_back({.N = static_cast<std::int64_t>(N_positions),
                            .value = value,
                            .lower = 1.0,
                            .upper = 1.0,
                            .label = placement.name});
    }
  };
  const auto named = [](const std::string& positions) {
    return Check{.statement = coincident,
                 .claim = "refused, and the message says why; so are particles that have crossed",
                 .subject = "particles",
                 .coordinates = {{"positions", positions}},
                 .quantity = "1 if refused"};
  };
  rows.add(named("coincident, crossed, not a number"), [=](Finding& row) { place(row, refused_placements()); });
  rows.add_control(named("a gap of one ulp"), "these particles are apart",
                   [=](Finding& row) { place(row, nearest_placements()); });
}

void add_nearest(ExtremeRows& rows, const SchemeChoice& scheme) {
  const Subject subject = subject_on(scheme, scene_with("1"));
  const std::vector<double> ratios = {1e-12, 0.5, 3.5};
  const auto at_each = [ratios](Finding& row, const Subject& one, auto measure) {
    const double h = 1.0 / static_cast<double>(N_positions);
    for (const Placement& placement : nearest_placements()) {
      for (const double ratio : ratios) {
        PlacedScheme placed(one.scheme, *one.scene, one.mu, placement.x, ratio * h);
        Point point = measure(placed);
        point.N = static_cast<std::int64_t>(N_positions);
        point.h = h;
        point.delta = ratio * h;
        point.variable = ratio;
        point.label = placement.name;
        row.points.push_back(point);
      }
    }
    row.variable = "delta/h";
  };
  const auto first_moment = [](PlacedScheme& placed) {
    Point worst{.value = 0.0, .upper = row_round_off(placed.particles())};
    for (std::ptrdiff_t j = 0; j < static_cast<std::ptrdiff_t>(placed.size()); ++j) {
      const Stencil stencil = placed.scheme().stencil(j);
      const double* const x = placed.particles().x.at(j);
      double moment = 0.0;
      for (std::size_t k = 0; k < stencil.offset.size(); ++k) {
        moment += std::abs((x[stencil.offset[k]] - x[0]) * stencil.weight[k]) / stencil.renormalization;
      }
      if (worse(std::abs(moment - 1.0), worst.value)) worst.value = std::abs(moment - 1.0);
    }
    return worst;
  };
  const auto but_for_one_gap = [](Check check) {
    check.coordinates.front() = {"arrangement", "uniform but for one gap of an ulp"};
    return check;
  };
  const auto moment_of = [&](const Subject& one) {
    return but_for_one_gap(one.check(coincident, "a gap of one ulp: weights are finite, their first moment one",
                                     {{"of", "first moment"}}, "max |first moment - 1|"));
  };
  rows.add(moment_of(subject), [=](Finding& row) { at_each(row, subject, first_moment); });
  if (const auto wrong = mistaken(subject, scheme.model->mistakes.inconsistent)) {
    rows.add_control(moment_of(*wrong), "a part of the kernel is missing",
                     [=](Finding& row) { at_each(row, *wrong, first_moment); });
  }

  const auto norm_at = [&](double cfl) {
    return but_for_one_gap(subject.check(coincident, "a gap of one ulp, c constant: a step at CFL 1 has the max norm 1",
                                         {at_cfl(cfl)}, "max norm of I + dt R"));
  };
  const auto step = [=](Finding& row, double cfl) {
    at_each(row, subject, [&](PlacedScheme& placed) {
      const double dt = cfl * largest_step(subject, placed, StepCondition::corrected);
      return Point{.value = step_norm(placed, dt), .upper = 1.0 + step_round_off(subject, placed.particles())};
    });
  };
  rows.add(norm_at(1.0), [=](Finding& row) { step(row, 1.0); });
  rows.add_control(norm_at(1.5), "beyond the condition", [=](Finding& row) { step(row, 1.5); });
}

}  // namespace

void add_rows_of_positions(ExtremeRows& rows, const Extremes& extremes) {
  add_refusals(rows);
  for (const SchemeChoice& scheme : standing_schemes(extremes)) add_nearest(rows, scheme);
}

}  // namespace acstudy
