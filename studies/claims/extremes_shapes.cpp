#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/claims/extreme_rows.hpp"

namespace acstudy {

namespace {

const std::string square_wave_and_hat = "square wave and hat";

struct Shape {
  std::string name;
  double (*u_0)(double);
  double order;  ///< in L1: the diffusion of a step of length h spreads a jump over sqrt(h), a kink's error is O(h)
};

double wrapped(double x) { return x - std::floor(x); }

/// 1 between 1/4 and 3/4, the mean where it jumps, so that samples see the jump where it is.
double square_wave(double x) {
  const double inside = 0.25 - std::abs(wrapped(x) - 0.5);
  return inside > 1e-9 ? 1.0 : inside < -1e-9 ? 0.0 : 0.5;
}
double hat(double x) { return std::max(0.0, 1.0 - 4.0 * std::abs(wrapped(x) - 0.5)); }

const std::vector<Shape> shapes = {{"square wave", square_wave, 0.5}, {"hat", hat, 1.0}};

double variation(std::span<const double> values) {
  double sum = std::abs(values.front() - values.back());
  for (std::size_t j = 1; j < values.size(); ++j) sum += std::abs(values[j] - values[j - 1]);
  return sum;
}

/// What is followed: how far values leave [0, 1], or the growth of the total variation.
enum class Carried { range, variation };

void carry(Finding& row, const Subject& subject, Carried followed) {
  constexpr std::int64_t N = 120;
  const double h = 1.0 / static_cast<double>(N);
  for (const Shape& shape : shapes) {
    for (const double ratio : {0.4, 1.0, 3.5, 12.0}) {
      for (const std::vector<double>& x : subject.positions(N)) {
        const std::vector<double> u = values_at(x, shape.u_0);
        // Exactly CFL 1 for forward Euler, and half of it.
        for (const double cfl : {1.0, 0.5}) {
          const double dt = cfl * step_at_cfl_one(subject, x, ratio * h);
          const std::int64_t steps = 150;
          const double start = variation(u);
          double farthest = followed == Carried::range ? 0.0 : 1.0;
          Particles particles(x.size(), 1.0, ratio * h);
          particles.place(x);
          run_freely(subject, {x, u}, ratio * h, static_cast<double>(steps) * dt, steps,
                     [&](const TimeStep&, std::span<const double>, std::span<const double> values) {
                       const double now =
                           followed == Carried::range ? excursion(values, 0.0, 1.0) : variation(values) / start;
                       if (worse(now, farthest)) farthest = now;
                     });
          const double rounded = static_cast<double>(steps) * step_round_off(subject, particles);
          row.points.push_back(
              {.N = N,
               .h = h,
               .delta = ratio * h,
               .variable = ratio,
               .value = farthest,
               .upper = followed == Carried::range ? rounded : 1.0 + 2.0 * static_cast<double>(N) * rounded / start,
               .label = fmt::format("{}, CFL {:g}", shape.name, cfl)});
        }
      }
    }
  }
  row.variable = "delta/h";
}

void add_monotone(ExtremeRows& rows, const SchemeChoice& scheme, Arrangement arrangement) {
  const Subject subject = subject_on(scheme, scene_with("1"), arrangement);
  const Mistakes& mistakes = scheme.model->mistakes;
  const auto wrong = mistaken(subject, mistakes.not_monotone), classical = mistaken(subject, mistakes.classical);
  const auto add = [&](const std::string& claim, const std::string& quantity, Carried followed) {
    const auto named = [&](const Subject& one) {
      return one.check(square_wave_and_hat, claim,
                       {{"of", followed == Carried::range ? "range" : "total variation"},
                        {"cfl", "1 and 1/2", "150 steps at CFL 1 and 1/2"}},
                       quantity);
    };
    rows.add(named(subject), [=](Finding& row) { carry(row, subject, followed); });
    const auto add_control = [&](const Subject& one, const std::string& why) {
      rows.add_control(named(one), why, [=](Finding& row) { carry(row, one, followed); });
    };
    if (wrong) add_control(*wrong, "a scheme that is not monotone");
    if (classical) add_control(*classical, "the classical sum is not monotone");
  };
  add("c constant: no over- or undershoot up to CFL 1", "largest excursion from [0, 1]", Carried::range);
  // On equal gaps a step is an average of shifted copies, whose total variation is at most that of one of them.
  if (arrangement == Arrangement::uniform) {
    add("c constant, equal gaps: the total variation does not grow", "total variation / its start", Carried::variation);
  }
}

/// L1 errors at T = 1/4, weighted by cell width, along delta = ratio h.
void refine(Finding& row, const Subject& subject, const Shape& shape, double ratio, std::int64_t levels) {
  for (std::int64_t level = 0; level < levels; ++level) {
    const std::int64_t N = std::int64_t{64} << level;
    const double h = 1.0 / static_cast<double>(N), T = 0.25;
    const std::vector<double> x = subject.positions(N).front();
    const State end = run_freely(subject, {x, values_at(x, shape.u_0)}, ratio * h, T,
                                 steps_for(T, 0.5 * step_at_cfl_one(subject, x, ratio * h)));
    double error = 0.0;
    for (std::size_t j = 0; j < x.size(); ++j) {
      const double right = j + 1 < x.size() ? x[j + 1] : x[0] + 1.0, left = j > 0 ? x[j - 1] : x.back() - 1.0;
      // A jump may be at the particle itself, in the middle of its cell.
      constexpr double beside = 2e-9;
      const double before = std::abs(end.u[j] - shape.u_0(x[j] - T - beside));
      const double after = std::abs(end.u[j] - shape.u_0(x[j] - T + beside));
      error += 0.5 * (right - left) * 0.5 * (before + after);
    }
    row.points.push_back({.N = N, .h = h, .delta = ratio * h, .variable = h, .value = error});
  }
}

void add_orders(ExtremeRows& rows, const SchemeChoice& scheme, Arrangement arrangement, std::int64_t levels) {
  const Subject subject = subject_on(scheme, scene_with("1"), arrangement);
  for (const Shape& shape : shapes) {
    for (const double ratio : {0.4, 3.5}) {
      const auto named = [&](double order) {
        Check check = subject.check(
            square_wave_and_hat, fmt::format("the {} has order {} in L1", shape.name, shape.order == 1.0 ? "1" : "1/2"),
            {{"shape", shape.name}, at_ratio(ratio), {"cfl", 0.5, "CFL 1/2"}}, "L1 error at T = 1/4", Test::order);
        check.theory_order = order;
        if (order != shape.order)
          check.coordinates.emplace_back("order", order, order == 1.0 ? "asked for order 1" : "asked for order 1/2");
        return check;
      };
      rows.add(named(shape.order), [=](Finding& row) { refine(row, subject, shape, ratio, levels); });
      if (ratio > 1.0 || arrangement != Arrangement::uniform) continue;
      rows.add_control(
          named(shape.order == 1.0 ? 0.5 : 1.0), "it is not the other one's order",
          [=](Finding& row) { refine(row, subject, shape, ratio, levels); },
          shape.order == 1.0 ? Verdict::above : Verdict::below);
    }
  }
}

}  // namespace

void add_rows_of_shapes(ExtremeRows& rows, const Extremes& extremes) {
  for (const SchemeChoice& scheme : standing_schemes(extremes)) {
    for (const Arrangement arrangement : {Arrangement::uniform, Arrangement::jittered}) {
      add_monotone(rows, scheme, arrangement);
    }
    for (const Arrangement arrangement : {Arrangement::uniform, Arrangement::jittered}) {
      add_orders(rows, scheme, arrangement, extremes.levels);
    }
  }
}

}  // namespace acstudy
