#include "reports/judging/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace acstudy {

namespace {

struct Conclusion {
  Verdict verdict;
  std::string reason;
};

std::string listed(std::span<const Difference> differences) {
  std::string text;
  for (const Difference& d : differences) text += fmt::format("{}{:+.3g}", text.empty() ? "" : ", ", d.difference);
  return text;
}

bool same_sign(const Difference& a, const Difference& b) { return a.difference * b.difference > 0.0; }

/// The number of differences at the end that have one sign.
std::size_t monotone_end(std::span<const Difference> differences) {
  std::size_t count = std::min<std::size_t>(1, differences.size());
  while (count < differences.size() && std::signbit(differences[differences.size() - count].difference) ==
                                           std::signbit(differences[differences.size() - count - 1].difference)) {
    ++count;
  }
  return count;
}

/// A verdict that needs no fit.
std::optional<Conclusion> unusable(std::span<const Difference> differences) {
  for (std::size_t i = 0; i < differences.size(); ++i) {
    const Difference& d = differences[i];
    for (const double variable : {d.variable, d.finer}) {
      if (!(variable > 0.0) || !std::isfinite(variable)) {
        return Conclusion{Verdict::inconclusive, fmt::format("the variable of level {} is {:.3g}; it must be positive",
                                                             variable == d.finer ? i + 2 : i + 1, variable)};
      }
    }
    if (!(d.finer < d.variable)) {
      return Conclusion{Verdict::inconclusive,
                        fmt::format("level {} does not refine level {}: the variable goes from {:.3g} to {:.3g}", i + 2,
                                    i + 1, d.variable, d.finer)};
    }
    if (!std::isfinite(d.difference)) {
      return Conclusion{Verdict::unstable, fmt::format("level {} or {} is not finite", i + 1, i + 2)};
    }
  }
  if (differences.size() < 2) {
    return Conclusion{Verdict::inconclusive,
                      fmt::format("{} level(s); an order takes 3, an interval 4", differences.size() + 1)};
  }
  const Difference& last = differences.back();
  if (std::abs(last.difference) <= last.digits) {
    return Conclusion{Verdict::floor, fmt::format("the last difference, {:.2g}, is no more than the digits leave open",
                                                  std::abs(last.difference))};
  }
  return std::nullopt;
}

/// `judge` of the errors that differences stand for. At unequal ratios these depend a little on the order.
Judgement judge_errors(std::span<const Difference> differences, double theory, const JudgeOptions& options) {
  double p = theory > 0.0 ? theory : 1.0;
  Judgement judgement;
  for (int pass = 0; pass < 4; ++pass) {
    std::vector<Level> levels;
    for (const Difference& difference : differences) levels.push_back(level_of(difference, p));
    judgement = judge(levels, theory, options);
    const double order = judgement.fitted.order;
    if (std::isnan(order) || std::abs(order - p) <= 1e-6) break;
    p = std::clamp(order, 0.1, 20.0);
  }
  return judgement;
}

bool supports(Verdict verdict) { return verdict == Verdict::confirmed || verdict == Verdict::pre_asymptotic; }

/// Three levels, or values that swing to the end: what can be said without an interval.
Conclusion conclude_without_fit(const ValueJudgement& result, std::size_t monotone) {
  const std::span<const Difference> all = result.differences;
  const Difference &before = all[all.size() - 2], &last = all.back();
  const bool swings = !same_sign(before, last);
  const double order = result.pairwise.back();
  if (order < -order_tolerance) {
    return {Verdict::diverges, fmt::format("the values {}diverge: differences {} grow, order {:.2f}",
                                           swings ? "swing and " : "", listed(all), order)};
  }
  if (swings || monotone < all.size()) {
    return {Verdict::inconclusive,
            fmt::format("the values oscillate: differences {} change sign, the last by a factor of {:.3g}, and show no "
                        "order to judge",
                        listed(all), last.difference / before.difference)};
  }
  return {Verdict::inconclusive,
          fmt::format("three levels solve exactly for the order, {:.3f}; an interval takes a fourth level", order)};
}

/// Richardson extrapolation of the two finest levels.
double richardson(double finest, const Difference& last, double order) {
  if (!(order > 0.0)) return not_estimated;
  return finest - last.difference / std::expm1(order * std::log(last.variable / last.finer));
}

ValueJudgement judge_either(std::span<const Value> values, std::vector<Difference> differences, double theory,
                            const JudgeOptions& options) {
  ValueJudgement result;
  result.differences = std::move(differences);
  const std::span<const Difference> all = result.differences;
  for (std::size_t i = 1; i < all.size(); ++i) {
    result.pairwise.push_back(order_between(all[i - 1], all[i]).value_or(not_estimated));
  }
  if (auto conclusion = unusable(all)) {
    result.verdict = conclusion->verdict;
    result.reason = std::move(conclusion->reason);
    return result;
  }
  result.least_squares = least_squares_uncertainty(values);
  const std::size_t monotone = monotone_end(all);
  const bool fits = monotone >= 3;
  double observed = result.pairwise.back();
  if (!fits) {
    const Conclusion conclusion = conclude_without_fit(result, monotone);
    result.verdict = conclusion.verdict;
    result.reason = conclusion.reason;
    result.order = observed;
    if (!values.empty()) result.extrapolated = richardson(values.back().value, all.back(), observed);
    const bool one_side = monotone == all.size();
    result.gci = grid_convergence_index(all.back(), observed, result.pairwise, theory, one_side);
    return result;
  }

  const std::size_t left_out = all.size() - monotone;
  const Judgement judgement = judge_errors(all.subspan(left_out), theory, options);
  result.verdict = judgement.verdict;
  result.first = left_out + judgement.window.first;
  static_cast<Estimate&>(result) = judgement;
  observed = judgement.fitted.order;
  if (!values.empty()) {
    const std::span<const Value> inside = values.subspan(result.first);
    result.fitted = fit_value_law(inside);
    result.corrected = fit_corrected_value_law(inside);
    const ValueLaw& law = inside.size() > 4 ? result.corrected : result.fitted;
    static_cast<Estimate&>(result) = law;
    result.extrapolated = law.value;
    result.extrapolated_low = law.value_low;
    result.extrapolated_high = law.value_high;
    observed = result.fitted.order;
  }
  result.gci =
      grid_convergence_index(all.back(), observed, std::span(result.pairwise).subspan(result.first), theory, true);

  result.reason = judgement.reason;
  if (result.verdict == Verdict::diverges) {
    result.reason = fmt::format("the values diverge: differences {}; {}", listed(all), result.reason);
    static_cast<Estimate&>(result) = {result.pairwise.back()};
    result.extrapolated = result.extrapolated_low = result.extrapolated_high = not_estimated;
    result.gci = {};
  }
  const bool against = result.verdict == Verdict::below || result.verdict == Verdict::above;
  if ((supports(result.verdict) && !result.contains(theory) &&
       std::abs(result.order - theory) > extrapolation_tolerance) ||
      (against && result.contains(theory))) {
    result.reason = fmt::format("the differences alone are {}, but the values have order {:.2f} [{:.2f}, {:.2f}]: {}",
                                name_of(result.verdict), result.order, result.low, result.high, result.reason);
    result.verdict = Verdict::inconclusive;
  }
  if (left_out > 0) {
    result.reason +=
        fmt::format("; the values change direction before level {}, and coarser levels are left out", left_out + 1);
  }
  return result;
}

}  // namespace

ValueJudgement judge_values(std::span<const Value> values, double theory_order, const JudgeOptions& options) {
  return judge_either(values, differences_of(values), theory_order, options);
}

ValueJudgement judge_differences(std::span<const Difference> differences, double theory_order,
                                 const JudgeOptions& options) {
  return judge_either({}, {differences.begin(), differences.end()}, theory_order, options);
}

}  // namespace acstudy
