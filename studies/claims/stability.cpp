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

}  // namespace

Finding step_is_bounded(const Subject& subject, const Sweep& sweep, StepCondition condition, double cfl) {
  const bool corrected = condition == StepCondition::corrected;
  const StepLemma& lemma = subject.scheme.model->step_lemma;
  const FieldBounds fields = field_bounds(*subject.scene, subject.t());
  const double growth = fields.c_hat_1 + fields.b_1;
  // A control is stepped as the scheme that it is taken for.
  SchemeChoice itself = subject.scheme;
  itself.control = nullptr;
  Finding finding = subject.finding(std::string(corrected ? lemma.row_by_row : lemma.name),
                                    growth == 0.0 ? "maximum principle" : "norm <= 1 + dt (||c_hat'|| + ||b'||)",
                                    fmt::format("CFL {:g}", cfl), "max norm of I + dt R", Test::bounds);
  finding.variable = "delta/h";
  if (cfl > 1.0) {
    finding.promised = finding.expected = Verdict::violated;
    finding.remark = "negative control: beyond the condition the norm exceeds the bound";
  }
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
  judge(finding);
  return finding;
}

Finding printed_condition_on_uneven_gaps(const Subject& subject, const std::vector<std::int64_t>& N) {
  const FieldBounds fields = field_bounds(*subject.scene, 0.0);
  Finding finding = subject.finding(std::string(subject.scheme.model->step_lemma.name),
                                    "norm <= 1 + dt (||c_hat'|| + ||b'||)", {}, "max norm of I + dt R", Test::bounds);
  finding.check = "uneven gaps, h/2 h/2 3h/2 3h/2 ..., delta just below 2h, CFL 1";
  finding.variable = "delta/h";
  finding.expected = Verdict::violated;
  finding.remark =
      "the proof takes reach_j/|x_i - x_j| for one; between two close neighbors and two just beyond the horizon it is "
      "almost four";
  for (const std::int64_t count : N) {
    const double h = subject.scene->period() / static_cast<double>(count), delta = (2.0 - 1e-6) * h;
    std::vector<double> x;
    for (std::int64_t j = 0; j < count; ++j) {
      constexpr double start[] = {0.0, 0.5, 1.0, 2.5};
      x.push_back(h * (static_cast<double>(j / 4 * 4) + start[j % 4]));
    }
    PlacedScheme placed(subject.scheme, *subject.scene, subject.mu, x, delta);
    const double dt = largest_step(subject, placed, StepCondition::printed);
    finding.points.push_back({.N = count,
                              .h = h,
                              .delta = delta,
                              .variable = delta / h,
                              .value = step_norm(placed, dt),
                              .upper = norm_bound(subject, placed, dt, fields.c_hat_1 + fields.b_1)});
  }
  judge(finding);
  return finding;
}

}  // namespace acstudy
