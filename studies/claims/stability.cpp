#include "studies/claims/stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace acstudy {

double largest_step(const Subject& subject, PlacedScheme& placed, StepCondition condition) {
  const Particles& particles = placed.particles();
  const auto x = particles.x.values();
  if (condition == StepCondition::printed) {
    const double smallest = gaps({x.begin(), x.end()}, particles.period).smallest;
    return smallest / subject.scheme.model->step_lemma.speed(*subject.scene, subject.mu);
  }
  return 1.0 / placed.scheme().rows()->strongest_decay();
}

namespace {

/// 1 + dt (||c_hat'|| + ||b'||) and the round-off of a row sum.
double norm_bound(const Subject& subject, const PlacedScheme& placed, double dt, double growth) {
  const double terms = subject.scheme.model->row_terms * (2.0 * placed.particles().windows.widest + 8.0);
  return 1.0 + dt * growth + terms * std::numeric_limits<double>::epsilon();
}

/// ||c_hat'|| + ||b'||, 0 for a constant velocity.
double growth_rate(const Scene& scene, double t) {
  const FieldBounds fields = field_bounds(scene, t);
  return fields.c_hat_1 + fields.b_1;
}

void measure_norms(Finding& finding, const Subject& subject, const Sweep& sweep, StepCondition condition, double cfl,
                   double growth) {
  // A control is stepped as the scheme that it is taken for.
  SchemeChoice itself = subject.scheme;
  itself.control = nullptr;
  for (const std::int64_t N : sweep.N) {
    const double h = subject.scene->period() / static_cast<double>(N);
    for (const double delta : sweep.deltas(N, subject.scene->period())) {
      Point worst{.N = N, .h = h, .delta = delta, .variable = delta / h, .upper = NAN};
      for (const std::vector<double>& x : subject.positions(N)) {
        PlacedScheme placed(subject.scheme, *subject.scene, subject.mu, x, delta);
        PlacedScheme right(itself, *subject.scene, subject.mu, x, delta);
        const double dt = cfl * largest_step(subject, right, condition), norm = step_norm(placed, dt);
        const double bound = norm_bound(subject, placed, dt, growth);
        if (std::isnan(worst.upper) || worse(norm - bound, worst.value - worst.upper)) {
          worst.value = norm;
          worst.upper = bound;
        }
      }
      finding.points.push_back(worst);
    }
  }
}

/// Between two close neighbors and two just beyond the horizon a row needs almost four times what the lemma says.
Point norm_on_uneven_gaps(const Subject& subject, std::int64_t N) {
  const double h = subject.scene->period() / static_cast<double>(N), delta = (2.0 - 1e-6) * h;
  std::vector<double> x;
  for (std::int64_t j = 0; j < N; ++j) {
    constexpr double start[] = {0.0, 0.5, 1.0, 2.5};
    x.push_back(h * (static_cast<double>(j / 4 * 4) + start[j % 4]));
  }
  PlacedScheme placed(subject.scheme, *subject.scene, subject.mu, x, delta);
  const double dt = largest_step(subject, placed, StepCondition::printed);
  return {.N = N,
          .h = h,
          .delta = delta,
          .variable = delta / h,
          .value = step_norm(placed, dt),
          .upper = norm_bound(subject, placed, dt, growth_rate(*subject.scene, 0.0))};
}

constexpr const char* bounded = "norm <= 1 + dt (||c_hat'|| + ||b'||)";

}  // namespace

Measurement step_is_bounded(const Subject& subject, const Sweep& sweep, StepCondition condition, double cfl) {
  const bool corrected = condition == StepCondition::corrected;
  const StepLemma& lemma = subject.scheme.model->step_lemma;
  const double growth = growth_rate(*subject.scene, subject.t());
  Check check = subject.check(std::string(corrected ? lemma.row_by_row : lemma.name),
                              growth == 0.0 ? "maximum principle" : bounded, {at_cfl(cfl)}, "max norm of I + dt R");
  check.variable = "delta/h";
  if (cfl > 1.0) {
    check.be_control("beyond the condition the norm exceeds the bound");
    check.promised = Verdict::violated;
  }
  return {check, [=](Finding& finding) { measure_norms(finding, subject, sweep, condition, cfl, growth); }};
}

Measurement printed_condition_on_uneven_gaps(const Subject& subject, const std::vector<std::int64_t>& N) {
  Check check =
      subject.check(std::string(subject.scheme.model->step_lemma.name), bounded,
                    {{"gaps", "h/2 h/2 3h/2 3h/2 ..."}, {"delta", "just below 2h", "delta just below 2h"}, at_cfl(1.0)},
                    "max norm of I + dt R");
  check.coordinates.front() = {"arrangement", "uneven gaps"};
  check.variable = "delta/h";
  check.expected = Verdict::violated;
  check.remark =
      "the proof takes reach_j/|x_i - x_j| for one; between two close neighbors and two just beyond the horizon it is "
      "almost four";
  return {check, [=](Finding& finding) {
            for (const std::int64_t count : N) finding.points.push_back(norm_on_uneven_gaps(subject, count));
          }};
}

}  // namespace acstudy
