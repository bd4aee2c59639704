#include "studies/claims/consistency.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace acstudy {

namespace {

double variable(const LemmaEstimate& estimate, double h, double delta) {
  return estimate.nonlocal ? h : std::max(h, delta);
}

/// What the statement says, and what is known to hold instead.
std::string claim(const LemmaEstimate& estimate) {
  if (!estimate.nonlocal) return "O(max(h, delta))";
  return estimate.second_term.empty() ? "O(h), whatever delta" : fmt::format("O(h) + O({})", estimate.second_term);
}

double reach(const Particles& particles, std::ptrdiff_t j) {
  const double* const x = particles.x.at(j);
  return std::max({particles.delta, x[0] - x[-particles.windows.left[j]], x[particles.windows.right[j]] - x[0]});
}

/// The errors of an estimate at one horizon. Finding the sources' quadrature costs more than using it, so they are made
/// once for all arrangements.
class ErrorAt {
 public:
  ErrorAt(const Subject& subject, const LemmaEstimate& estimate, double delta)
      : subject_(subject), estimate_(estimate), delta_(delta), inviscid_(source(0.0)) {
    if (estimate.viscous && estimate.nonlocal) viscous_ = source(strong());
  }

  double operator()(const std::vector<double>& x) {
    const Scene& scene = *subject_.scene;
    const double t = subject_.t();
    PlacedScheme inviscid(subject_.scheme, scene, 0.0, x, delta_);
    if (!estimate_.viscous) return max_norm(inviscid.truncation_error(*inviscid_, t));

    PlacedScheme viscous(subject_.scheme, scene, strong(), x, delta_);
    const auto positions = viscous.particles().x.values();
    std::vector<double> u(x.size());
    scene.u(positions, t, u);
    std::vector<double> D = viscous.rate(u);
    const std::vector<double> rest = inviscid.rate(u);
    for (std::size_t j = 0; j < x.size(); ++j) D[j] = (D[j] - rest[j]) / strong();
    if (!estimate_.nonlocal) return max_norm(D);

    std::vector<double> f(x.size()), f_viscous(x.size());
    inviscid_->place(positions);
    inviscid_->evaluate(t, f);
    viscous_->place(positions);
    viscous_->evaluate(t, f_viscous);
    for (std::size_t j = 0; j < x.size(); ++j) {
      D[j] = D[j] / reach(viscous.particles(), static_cast<std::ptrdiff_t>(j)) - (f[j] - f_viscous[j]);
    }
    return max_norm(D);
  }

 private:
  /// A viscosity bound with which the viscous term is not lost in the others' round-off.
  double strong() const { return 1.0 / delta_; }
  std::unique_ptr<Source> source(double mu) const {
    return make_source(subject_.scheme, *subject_.scene, mu, estimate_.nonlocal, delta_);
  }

  const Subject& subject_;
  const LemmaEstimate& estimate_;
  double delta_;
  std::unique_ptr<Source> inviscid_, viscous_;
};

struct Worst {
  double error = 0.0, h = 0.0;
};

/// The largest error over the arrangements, and the largest gap.
Worst worst(const Subject& subject, const LemmaEstimate& estimate, std::int64_t N, double delta) {
  Worst result;
  ErrorAt error_at(subject, estimate, delta);
  for (const std::vector<double>& x : subject.positions(N)) {
    const double error = error_at(x);
    if (worse(error, result.error)) result.error = error;
    result.h = std::max(result.h, gaps(x, subject.scene->period()).largest);
  }
  return result;
}

}  // namespace

double estimate_error(const Subject& subject, const LemmaEstimate& estimate, const std::vector<double>& x,
                      double delta) {
  return ErrorAt(subject, estimate, delta)(x);
}

namespace {

void measure_whatever_delta(Finding& finding, const Subject& subject, const LemmaEstimate& estimate,
                            const Resolutions& resolutions) {
  const FieldBounds fields = field_bounds(*subject.scene, subject.t());
  for (const std::int64_t N : resolutions.N) {
    Point point{.N = N};
    Gaps gap{0.0, HUGE_VAL};  // of all arrangements
    for (const std::vector<double>& x : subject.positions(N)) {
      const Gaps one = gaps(x, subject.scene->period());
      gap = {std::max(gap.largest, one.largest), std::min(gap.smallest, one.smallest)};
    }
    for (const double delta : resolutions.deltas(N, subject.scene->period())) {
      const double bound =
          estimate.constant({fields, subject.scheme.kernel, subject.scheme.nonlocal_divergence, gap, delta});
      const double ratio = worst(subject, estimate, N, delta).error / variable(estimate, gap.largest, delta);
      if (!std::isnan(point.h) && !worse(ratio / bound, point.value / point.upper)) continue;
      point = {N, gap.largest, delta, gap.largest, ratio, point.lower, bound};
    }
    finding.points.push_back(point);
  }
}

/// What an estimate is measured by: its statement and quantity.
Check check_of(const Subject& subject, const LemmaEstimate& estimate, const std::string& claim,
               const Coordinate& condition, Test test) {
  return subject.check(std::string(estimate.statement), claim, {condition}, std::string(estimate.quantity), test);
}

}  // namespace

Measurement consistency_whatever_delta(const Subject& subject, const LemmaEstimate& estimate,
                                       const Resolutions& resolutions) {
  Check check = check_of(subject, estimate, claim(estimate), {"delta", "whatever delta"}, Test::bounds);
  check.quantity += estimate.nonlocal ? " / h" : " / max(h, delta)";
  if (!estimate.second_term.empty()) {
    check.remark = "C h holds whatever delta, so the printed second term is not needed";
  }
  return {check, [=](Finding& finding) { measure_whatever_delta(finding, subject, estimate, resolutions); }};
}

Measurement consistency_along(const Subject& subject, const LemmaEstimate& estimate, const PathChoice& path) {
  Check check =
      check_of(subject, estimate, claim(estimate), {"path", path.name}, path.order ? Test::order : Test::rate);
  check.coordinates.push_back(unspoken({"delta", path.delta.text()}));
  check.theory_order = path.order.value_or(1.0);
  const bool settles = check.theory_order == 0.0, in_h = estimate.nonlocal || settles;
  check.variable = in_h ? "h" : "max(h,delta)";
  if (settles) {
    check.claim = "does not vanish as h -> 0 at a fixed delta";
    check.promised = Verdict::stagnates;
  }
  check.expected = path.expect.value_or(check.promised);
  return {check, [=](Finding& finding) {
            for (const std::int64_t N : path.N) {
              const double count = static_cast<double>(N), delta = path.delta({subject.scene->period() / count, count});
              const Worst at = worst(subject, estimate, N, delta);
              finding.points.push_back({N, at.h, delta, in_h ? at.h : std::max(at.h, delta), at.error});
            }
          }};
}

Measurement order_below_spacing(const Subject& subject, const LemmaEstimate& estimate,
                                const std::vector<std::int64_t>& N, double ratio) {
  const bool smooth = subject.arrangement != Arrangement::jittered;
  Check check =
      check_of(subject, estimate, "order in h where delta << h", at_ratio(ratio), smooth ? Test::order : Test::rate);
  check.theory_order = smooth ? 2.0 : 1.0;
  check.remark = smooth ? "gaps differ by O(h^2): the nearest neighbors give central differences, O(h^2), and the "
                          "nonlocal operator is within O(delta^2) of their limit"
                        : "gaps differ by O(h): so do the difference quotients of the nearest neighbors from their "
                          "limit";
  return {check, [=](Finding& finding) {
            for (const std::int64_t count : N) {
              const double delta = ratio * subject.scene->period() / static_cast<double>(count);
              const Worst at = worst(subject, estimate, count, delta);
              finding.points.push_back({count, at.h, delta, at.h, at.error});
            }
          }};
}

Measurement growth_below_spacing(const Subject& subject, const LemmaEstimate& estimate, std::int64_t N,
                                 const std::vector<double>& ratios) {
  const std::string_view term = estimate.second_term;
  Check check = check_of(subject, estimate, fmt::format("grows like {} as delta -> 0", term),
                         {"delta", "delta -> 0 at fixed h"}, Test::order);
  check.variable = "delta";
  check.promised = Verdict::diverges;
  check.expected = Verdict::stagnates;
  check.remark = fmt::format(
      "not sharp: scheme and nonlocal operator are both within O(max(h, delta)) of the PDE's, so the error is O(h) "
      "where "
      "delta < h and {} is not attained",
      term);
  std::vector<double> below(ratios);
  std::erase_if(below, [](double ratio) { return ratio > 0.3; });
  std::sort(below.rbegin(), below.rend());
  return {check, [=](Finding& finding) {
            for (const double ratio : below) {
              const double delta = ratio * subject.scene->period() / static_cast<double>(N);
              const Worst at = worst(subject, estimate, N, delta);
              finding.points.push_back({N, at.h, delta, delta, at.error});
            }
          }};
}

Measurement truncation_along(const Subject& subject, const PathChoice& path,
                             const std::vector<Coordinate>& conditions) {
  const bool nonlocal = path.nonlocal_source;
  const ModelCard& model = *subject.scheme.model;
  const bool in_h = nonlocal || model.order_in_h;
  const std::string power = model.order == 1.0 ? "" : fmt::format("^{:g}", model.order);
  const std::string claim = fmt::format("truncation error O({}{})", in_h ? "h" : "max(h, delta)", power);
  Check check = subject.check(std::string(nonlocal ? model.to_nonlocal : model.to_pde), claim, conditions,
                              "max |rate + f - du/dt|", Test::rate);
  check.variable = in_h ? "h" : "max(h,delta)";
  check.theory_order = nonlocal ? 1.0 : model.order;
  return {check, [=](Finding& finding) {
            const Scene& scene = *subject.scene;
            for (const std::int64_t N : path.N) {
              const double count = static_cast<double>(N), delta = path.delta({scene.period() / count, count});
              const std::vector<double> x = subject.positions(N).front();
              const double h = gaps(x, scene.period()).largest;
              PlacedScheme placed(subject.scheme, scene, subject.mu, x, delta);
              const auto source = make_source(subject.scheme, scene, subject.mu, nonlocal, delta);
              finding.points.push_back({N, h, delta, in_h ? h : std::max(h, delta),
                                        max_norm(placed.truncation_error(*source, subject.t()))});
            }
          }};
}

}  // namespace acstudy
