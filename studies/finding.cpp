#include "studies/finding.hpp"

#include <fmt/format.h>

#include <cmath>

namespace acstudy {

namespace {

Judgement judge_bounds(const std::vector<Point>& points) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  Judgement judgement{};
  judgement.order = judgement.low = judgement.high = judgement.extrapolated = none;
  judgement.verdict = Verdict::violated;
  judgement.reason = "nothing was measured";
  // How far into its bounds a value has come: 1 at a bound, above 1 beyond.
  const auto excess = [](const Point& point) {
    if (std::isnan(point.value) || std::isnan(point.lower) || std::isnan(point.upper)) return HUGE_VAL;
    if (point.value > point.upper || point.value < point.lower) {
      return 1.0 + std::max(point.value - point.upper, point.lower - point.value);
    }
    return std::abs(point.value) / std::max(std::abs(point.lower), std::abs(point.upper));
  };
  const Point* worst = nullptr;
  for (const Point& point : points) {
    if (worst == nullptr || !(excess(point) <= excess(*worst))) worst = &point;
  }
  if (worst == nullptr) return judgement;
  judgement.verdict = excess(*worst) <= 1.0 ? Verdict::holds : Verdict::violated;
  const std::string where = (worst->N > 0 ? fmt::format(", N = {}", worst->N) : "") +
                            (std::isnan(worst->delta) ? "" : fmt::format(", delta = {:.3g}", worst->delta));
  const std::string demanded = std::isinf(worst->lower) ? fmt::format("at most {:.6g}", worst->upper)
                               : std::isinf(worst->upper)
                                   ? fmt::format("at least {:.6g}", worst->lower)
                                   : fmt::format("in [{:.6g}, {:.6g}]", worst->lower, worst->upper);
  judgement.reason = fmt::format("{} of {}: {:.6g}{}, {}", judgement.verdict == Verdict::holds ? "closest" : "worst",
                                 points.size(), worst->value, where, demanded);
  return judgement;
}

}  // namespace

std::string_view name_of(Test test) { return test == Test::order ? "order" : test == Test::rate ? "rate" : "bounds"; }

std::optional<Test> test_from(std::string_view name) {
  for (const Test test : {Test::order, Test::rate, Test::bounds}) {
    if (name_of(test) == name) return test;
  }
  return std::nullopt;
}

void judge(Finding& finding) {
  if (finding.test == Test::bounds) {
    finding.judgement = judge_bounds(finding.points);
    return;
  }
  std::vector<Level> levels;
  for (const Point& point : finding.points) levels.push_back({point.variable, point.value});
  Judgement& judgement = finding.judgement = judge(levels, finding.theory_order);
  if (finding.test == Test::order) return;
  switch (judgement.verdict) {
    case Verdict::confirmed:
    case Verdict::pre_asymptotic:
    case Verdict::above:
    case Verdict::floor:
      judgement.verdict = Verdict::holds;
      break;
    case Verdict::below:
      // Bounds are no asymptotes: errors may stray below them, as long as the interval, if it is not too wide to tell
      // half an order, reaches theory's.
      judgement.verdict =
          judgement.high >= finding.theory_order - order_tolerance && judgement.high - judgement.low < 1.0
              ? Verdict::holds
              : Verdict::violated;
      break;
    default:
      break;
  }
}

}  // namespace acstudy
