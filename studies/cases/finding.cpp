#include "studies/cases/finding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/cases/series_verdict.hpp"

namespace acstudy {

namespace {

/// Three significant digits, or as many, up to `most`, as tell a value from the bounds that it is not equal to.
int digits_apart(double value, std::initializer_list<double> bounds, int most) {
  int digits = 3;
  for (const double bound : bounds) {
    while (digits < most && value != bound &&
           fmt::format("{:.{}g}", value, digits) == fmt::format("{:.{}g}", bound, digits)) {
      ++digits;
    }
  }
  return digits;
}

Judgement judge_bounds(const std::vector<Point>& points) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Judgement judgement{};
  judgement.order = judgement.low = judgement.high = judgement.extrapolated = none;
  judgement.verdict = Verdict::violated;
  judgement.reason = "nothing was measured";
  // No value is within that is not finite: a file has null for each of these.
  const auto within = [](const Point& point) {
    return std::isfinite(point.value) && point.lower <= point.value && point.value <= point.upper;
  };
  // The distance to the nearer bound, positive within.
  const auto room = [](const Point& point) { return std::min(point.value - point.lower, point.upper - point.value); };
  const auto worse = [&](const Point& a, const Point& b) {
    return within(a) != within(b) ? within(b) : room(a) < room(b);
  };
  const auto worst = std::min_element(points.begin(), points.end(), worse);
  if (worst == points.end()) return judgement;
  const auto bounded = [](const Point& p) { return std::isfinite(p.lower) || std::isfinite(p.upper); };
  if (std::none_of(points.begin(), points.end(), bounded) && within(*worst)) {
    judgement.verdict = Verdict::inconclusive;
    judgement.reason = "theory bounds none of the values";
    return judgement;
  }
  judgement.verdict = within(*worst) ? Verdict::holds : Verdict::violated;
  const std::string where = (worst->label.empty() ? "" : ", " + worst->label) +
                            (worst->N > 0 ? fmt::format(", N = {}", worst->N) : "") +
                            (std::isnan(worst->delta) ? "" : fmt::format(", delta = {:.3g}", worst->delta));
  const bool holds = judgement.verdict == Verdict::holds;
  const int digits = digits_apart(worst->value, {worst->lower, worst->upper}, holds ? 6 : 17);
  const auto text = [&](double value) { return fmt::format("{:.{}g}", value, digits); };
  const std::string demanded = std::isinf(worst->lower) ? "at most " + text(worst->upper)
                               : std::isinf(worst->upper)
                                   ? "at least " + text(worst->lower)
                                   : fmt::format("in [{}, {}]", text(worst->lower), text(worst->upper));
  judgement.reason = fmt::format("{} of {}: {}{}, {}", holds ? "closest" : "worst", points.size(), text(worst->value),
                                 where, demanded);
  return judgement;
}

/// A power law with a wider interval than this, on either side, does not show that a bound on the order is met.
constexpr double widest_rate = 0.3;

/// A bound on errors is no asymptote: they may fall faster, or stray below it. Every pairwise order reaches theory's,
/// or the power law does, with an interval that is not too wide, and the order in the limit is not excluded.
bool reaches(const Judgement& judgement, double theory_order) {
  const double least = theory_order - order_tolerance;
  const auto& pairwise = judgement.pairwise;
  const auto all_above = [&](double bound) {
    return std::all_of(pairwise.begin(), pairwise.end(), [&](double order) { return order >= bound; });
  };
  // Levels that are no refinement have no fit, whatever their pairwise orders.
  if (std::isnan(judgement.fitted.order) || judgement.high < least) return false;
  if (all_above(least)) return true;
  const bool leaving =
      std::is_sorted(pairwise.rbegin(), pairwise.rend()) && pairwise.back() + judgement.fitted.half_width() < least;
  return all_above(0.0) && !leaving && judgement.fitted.high >= least && judgement.fitted.half_width() <= widest_rate;
}

/// What a judgement of an order says of a bound on it.
void judge_rate(Judgement& judgement, double theory_order) {
  switch (judgement.verdict) {
    case Verdict::confirmed:
    case Verdict::pre_asymptotic:
    case Verdict::above:
    case Verdict::floor:
      judgement.verdict = Verdict::holds;
      return;
    case Verdict::below:
    case Verdict::inconclusive:
      break;
    default:
      return;
  }
  if (reaches(judgement, theory_order)) {
    judgement.verdict = Verdict::holds;
    judgement.reason = fmt::format(
        "the power law's order {:.2f} [{:.2f}, {:.2f}] reaches theory's {:g}, or each pairwise order does; "
        "in the limit {:.2f} [{:.2f}, {:.2f}], which does not exclude it",
        judgement.fitted.order, judgement.fitted.low, judgement.fitted.high, theory_order, judgement.order,
        judgement.low, judgement.high);
  } else if (judgement.verdict == Verdict::below) {
    judgement.verdict = Verdict::violated;
  }
}

}  // namespace

void judge(Finding& finding) {
  if (finding.cases) {
    judge_series(finding);
    return;
  }
  if (!finding.failure.empty()) {
    finding.judgement = {};
    finding.judgement.verdict = Verdict::inconclusive;
    finding.judgement.reason = "it could not be measured: " + finding.failure;
    return;
  }
  if (finding.test == Test::bounds) {
    finding.judgement = judge_bounds(finding.points);
    return;
  }
  if (finding.test == Test::surface) {
    std::vector<SurfacePoint> points;
    for (const Point& point : finding.points) points.push_back({point.h, point.delta, point.value});
    finding.surface = fit_surface(points);
    finding.judgement = judge_surface(points, finding.theory_order);
    return;
  }
  std::vector<Level> levels;
  for (const Point& point : finding.points) levels.push_back({point.variable, point.value});
  finding.judgement = judge(levels, finding.theory_order, finding.known);
  if (finding.test == Test::rate) judge_rate(finding.judgement, finding.theory_order);
}

}  // namespace acstudy
