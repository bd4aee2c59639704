#include "reports/judging/orders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/judging/evidence.hpp"

namespace acstudy {

namespace {

struct NamedVerdict {
  Verdict verdict;
  std::string_view name;
};
constexpr NamedVerdict names[] = {
    {Verdict::confirmed, "confirmed"},
    {Verdict::pre_asymptotic, "pre-asymptotic"},
    {Verdict::below, "below"},
    {Verdict::above, "above"},
    {Verdict::stagnates, "stagnates"},
    {Verdict::floor, "floor"},
    {Verdict::diverges, "diverges"},
    {Verdict::unstable, "unstable"},
    {Verdict::inconclusive, "inconclusive"},
    {Verdict::holds, "holds"},
    {Verdict::violated, "violated"},
    {Verdict::determined, "determined"},
    {Verdict::stable, "stable"},
};

/// Errors of this size are round-off of a solution of size one, accumulated over a run.
constexpr double round_off = 1e-12;

/// Levels that are closer together, from the first to the last, tell an order as little as one level does: over so
/// little all laws are alike, and errors wander more than they fall.
constexpr double least_refinement = 1.2;
/// A verdict that needs no fit: levels that are no refinement, errors that are no errors, too few of them.
std::optional<Conclusion> unusable(LevelView levels, const JudgeOptions& options) {
  const double floor = std::max(options.floor.value_or(0.0), round_off * options.scale.value_or(0.0));
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (!std::isfinite(levels[i].error)) {
      return Conclusion{Verdict::unstable,
                        fmt::format("the error of level {} of {} is {}", i + 1, levels.size(), levels[i].error)};
    }
  }
  const auto inconclusive = [](std::string reason) { return Conclusion{Verdict::inconclusive, std::move(reason)}; };
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const Level& level = levels[i];
    if (level.error < 0.0)
      return inconclusive(fmt::format("the error of level {} is negative: {:.3g}", i + 1, level.error));
    if (!(level.variable > 0.0) || !std::isfinite(level.variable)) {
      return inconclusive(
          fmt::format("the variable of level {} is {:.3g}; it must be positive", i + 1, level.variable));
    }
    if (!(level.weight > 0.0) || !std::isfinite(level.weight)) {
      return inconclusive(fmt::format("the weight of level {} is {:.3g}; it must be positive", i + 1, level.weight));
    }
    if (i > 0 && !(level.variable < levels[i - 1].variable)) {
      return inconclusive(fmt::format("level {} does not refine level {}: the variable goes from {:.3g} to {:.3g}",
                                      i + 1, i, levels[i - 1].variable, level.variable));
    }
  }
  if (levels.size() < 3) {
    return inconclusive(fmt::format("{} level(s); an order with an interval needs at least 3", levels.size()));
  }
  if (levels.back().error <= floor) {
    return Conclusion{Verdict::floor,
                      fmt::format("the finest error, {:.2g}, is {}", levels.back().error,
                                  options.floor && levels.back().error <= *options.floor
                                      ? fmt::format("at the known floor of {:.2g}", *options.floor)
                                  : options.scale ? fmt::format("round-off of a solution of {:.2g}", *options.scale)
                                                  : "exactly zero")};
  }
  if (const double total = levels.front().variable / levels.back().variable; total < least_refinement) {
    return inconclusive(fmt::format("the variable falls by a factor of {:.3g} in all; an order takes {:g} at least",
                                    total, least_refinement));
  }
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (levels[i].error == 0.0) {
      return inconclusive(
          fmt::format("the error of level {} is exactly zero, though that of the finest is not", i + 1));
    }
  }
  return std::nullopt;
}

/// The finest orders go on in one direction, away from where the law of a window says that they go.
bool end_leaves_law(std::span<const double> pairwise, const CorrectedLaw& law) {
  if (pairwise.size() < 5) return false;
  const double last = pairwise.back(), before = pairwise[pairwise.size() - 2], third = pairwise[pairwise.size() - 3];
  return !law.contains(last) && (last - before) * (last - law.order) > 0.0 && (before - third) * (last - before) > 0.0;
}

void estimate(LevelView levels, Judgement& result) {
  result.window = asymptotic_window(levels);
  // A level that is off by little is no outlier where four finer ones follow their law without it, and no part of it.
  for (auto off = find_outlier(levels.subspan(result.window.first));
       off && std::abs(off->deviation) < std::log(harmless_factor) && off->level + 5 <= result.window.size();
       off = find_outlier(levels.subspan(result.window.first))) {
    result.window.first += off->level + 1;
  }
  LevelView inside = levels.subspan(result.window.first);
  result.corrected = fit_corrected_law(inside);
  if (end_leaves_law(std::span(result.pairwise).subspan(result.window.first), result.corrected)) {
    result.window.first = levels.size() - 5;
    inside = levels.subspan(result.window.first);
    result.corrected = fit_corrected_law(inside);
  }
  result.fitted = fit_power_law(inside);
  result.floored = fit_floored_law(inside);
  result.extrapolated = result.corrected.order;
  result.leave_one_out = leave_one_out(inside);
  result.leave_one_out.level += result.window.first;
  static_cast<Estimate&>(result) = inside.size() >= 4 ? static_cast<Estimate>(result.corrected) : result.fitted;
}

}  // namespace

std::string_view name_of(Verdict verdict) {
  return std::find_if(std::begin(names), std::end(names), [&](auto& entry) { return entry.verdict == verdict; })->name;
}

std::optional<Verdict> verdict_from(std::string_view text) {
  const auto* const found =
      std::find_if(std::begin(names), std::end(names), [&](auto& entry) { return entry.name == text; });
  return found == std::end(names) ? std::nullopt : std::optional(found->verdict);
}

bool meets(Verdict verdict, Verdict expected) {
  return verdict == expected || (expected == Verdict::confirmed && verdict == Verdict::pre_asymptotic) ||
         (expected == Verdict::stable && verdict != Verdict::unstable);
}

std::vector<Judgement> judge(std::span<const Level> levels, std::span<const double> theory_orders,
                             const JudgeOptions& options) {
  Judgement common;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    common.pairwise.push_back(std::log(levels[i - 1].error / levels[i].error) /
                              std::log(levels[i - 1].variable / levels[i].variable));
  }
  common.window = {0, levels.empty() ? 0 : levels.size() - 1};
  const std::optional<Conclusion> conclusion = unusable(levels, options);
  const bool positive = std::all_of(levels.begin(), levels.end(), [](const Level& level) { return level.error > 0.0; });
  if (!conclusion || (conclusion->verdict == Verdict::floor && positive)) estimate(levels, common);
  std::vector<Judgement> judgements;
  for (const double theory_order : theory_orders) {
    const Conclusion one = conclusion ? *conclusion : conclude(levels, theory_order, common, options);
    judgements.push_back(common);
    judgements.back().verdict = one.verdict;
    judgements.back().reason = one.reason;
  }
  return judgements;
}

Judgement judge(std::span<const Level> levels, double theory_order, const JudgeOptions& options) {
  return judge(levels, std::span(&theory_order, 1), options).front();
}

Judgement judge(std::span<const Level> levels, double theory_order) { return judge(levels, theory_order, {}); }

}  // namespace acstudy
