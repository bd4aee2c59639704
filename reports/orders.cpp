#include "reports/orders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

/// Errors of this size are round-off of a solution of order one, accumulated over a run.
constexpr double round_off = 1e-12;
/// A growth of the error by this factor, faster than by this power of the variable, is an instability and no order.
constexpr double explosion_factor = 10.0, explosion_power = 4.0;
/// Corrections v^q with a smaller q cannot be told from logarithms.
constexpr double slowest_correction = 0.4;

/// A last pairwise order farther off than this is no scatter that could be averaged away.
constexpr double widest_scatter = 0.25;

struct Conclusion {
  Verdict verdict;
  std::string reason;
};

std::string listed(std::span<const double> orders) {
  std::string text;
  for (const double order : orders) text += fmt::format("{}{:.2f}", text.empty() ? "" : ", ", order);
  return text;
}

std::string with_interval(const Estimate& estimate) {
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", estimate.order, estimate.low, estimate.high);
}

/// A verdict that needs no fit: levels that are no refinement, errors that are no errors, too few of them.
std::optional<Conclusion> unusable(LevelView levels, double floor) {
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
    return Conclusion{Verdict::floor, fmt::format("the finest error, {:.2g}, is round-off", levels.back().error)};
  }
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (levels[i].error == 0.0) {
      return inconclusive(
          fmt::format("the error of level {} is exactly zero, though that of the finest is not", i + 1));
    }
  }
  return std::nullopt;
}

void estimate(LevelView levels, Judgement& result) {
  const Asymptotics asymptotics = asymptotic_window(levels);
  result.window = asymptotics.window;
  const LevelView inside = levels.subspan(result.window.first);
  result.fitted = fit_power_law(inside);
  result.corrected = asymptotics.law.q == 1.0 ? fit_corrected_law(inside) : fit_corrected_law_and_q(inside);
  result.floored = fit_floored_law(inside);
  result.extrapolated = result.corrected.order;
  result.leave_one_out = leave_one_out(inside);
  result.leave_one_out.level += result.window.first;
  static_cast<Estimate&>(result) = inside.size() >= 4 ? static_cast<Estimate>(result.corrected) : result.fitted;
}

/// What finite, positive errors show whatever order theory gives, and what it needs to know of theory.
class Evidence {
 public:
  Evidence(LevelView levels, double theory, const Judgement& result)
      : all_(levels),
        inside_(levels.subspan(result.window.first)),
        theory_(theory),
        result_(result),
        pairwise_(std::span(result.pairwise).subspan(result.window.first)),
        last_(pairwise_.back()) {}

  Conclusion conclude() const {
    for (const auto question : {&Evidence::explodes, &Evidence::settles, &Evidence::grows, &Evidence::stops,
                                &Evidence::has_outlier, &Evidence::dwindles, &Evidence::wavers}) {
      if (auto answer = (this->*question)()) return *answer;
    }
    if (std::isnan(theory_)) {
      return inconclusive(
          fmt::format("no theory's order was given to judge by; {}, pairwise {}", estimates(), pairs()));
    }
    if (theory_ == 0.0) return inconclusive(fmt::format("the error has not settled: pairwise orders {}", pairs()));
    for (const auto question : {&Evidence::agrees_with_theory, &Evidence::moves_toward_theory}) {
      if (auto answer = (this->*question)()) return *answer;
    }
    return departs();
  }

 private:
  using Answer = std::optional<Conclusion>;

  static Conclusion inconclusive(std::string reason) { return {Verdict::inconclusive, std::move(reason)}; }

  std::string pairs() const { return listed(pairwise_); }

  std::string window() const {
    if (result_.window.first == 0) return "";
    return fmt::format(", levels {} to {} (the {} coarser do not follow their law)", result_.window.first + 1,
                       all_.size(), result_.window.first);
  }

  std::string estimates() const {
    if (inside_.size() < 4) return fmt::format("order {}", with_interval(result_.fitted));
    return fmt::format("order {}, with a correction {}{}", with_interval(result_.fitted),
                       with_interval(result_.corrected), window());
  }

  bool near(double order) const { return std::abs(order - theory_) <= order_tolerance; }

  /// Each pairwise order lies closer to theory's than the one before, or within the tolerance; all on one side.
  bool approaching() const {
    for (std::size_t i = 1; i < pairwise_.size(); ++i) {
      const double before = pairwise_[i - 1] - theory_, now = pairwise_[i] - theory_;
      if (near(pairwise_[i])) continue;
      if (!(std::abs(now) < std::abs(before)) || now * before < 0.0) return false;
    }
    return !near(pairwise_.front());
  }

  bool falling() const { return std::is_sorted(pairwise_.rbegin(), pairwise_.rend()); }

  /// Most of the finest error is a floor: the law with a floor fits better than a correction and, by an F test, a
  /// power.
  bool has_floor() const {
    const double share = result_.floored.F / all_.back().error;
    return share > 0.5 && share < 2.0 && result_.floored.residual < result_.corrected.residual &&
           significant(result_.fitted.residual, result_.floored.residual, inside_.size() - 3, 0.05);
  }

  Answer explodes() const {
    const auto smallest =
        std::min_element(all_.begin(), all_.end(), [](auto& a, auto& b) { return a.error < b.error; });
    const double growth = all_.back().error / smallest->error;
    const double power = std::log(growth) / std::log(smallest->variable / all_.back().variable);
    if (!(growth > explosion_factor && power > explosion_power)) return std::nullopt;
    return Conclusion{Verdict::unstable,
                      fmt::format("the error grows from {:.2g} to {:.2g}, like the variable to the power {:.1f}",
                                  smallest->error, all_.back().error, -power)};
  }

  Answer settles() const {
    if (theory_ != 0.0) return std::nullopt;
    const bool flat = std::abs(last_) <= order_tolerance || (std::abs(result_.fitted.order) <= order_tolerance &&
                                                             result_.fitted.half_width() <= widest_half_width);
    if (!flat && !has_floor()) return std::nullopt;
    return Conclusion{
        Verdict::stagnates,
        has_floor() ? fmt::format("the error settles at {:.3g}, as theory says: error = C v^{:.2f} + {:.3g} fits, "
                                  "pairwise orders {}",
                                  all_.back().error, result_.floored.order, result_.floored.F, pairs())
                    : fmt::format("the error settles at {:.3g}, as theory says: pairwise orders {}", all_.back().error,
                                  pairs())};
  }

  Answer grows() const {
    const double first = all_.front().error, last = all_.back().error;
    const double overall = std::log(first / last) / std::log(all_.front().variable / all_.back().variable);
    const bool twice = last_ < -order_tolerance && pairwise_[pairwise_.size() - 2] < -order_tolerance;
    if (!(overall < -order_tolerance) && !twice) return std::nullopt;
    return Conclusion{Verdict::diverges,
                      fmt::format("the error grows under refinement, from {:.2g} to {:.2g}: pairwise orders {}",
                                  twice ? all_[all_.size() - 3].error : first, last, pairs())};
  }

  Answer stops() const {
    const bool flat = std::abs(last_) <= order_tolerance && (falling() || result_.fitted.half_width() <= 1.0);
    const bool level =
        std::abs(result_.fitted.order) <= order_tolerance && result_.fitted.half_width() <= widest_half_width;
    if (theory_ == 0.0 || (!flat && !level)) return std::nullopt;
    return Conclusion{Verdict::stagnates,
                      fmt::format("the error stops falling at {:.3g}: pairwise orders {}", all_.back().error, pairs())};
  }

  Answer has_outlier() const {
    const std::size_t first = result_.window.first;
    const auto named = [&](std::size_t level, double deviation) {
      return inconclusive(
          fmt::format("level {} lies off the law of the others by a factor of {:.3g}; run it again, or leave "
                      "it out if it is too coarse; pairwise orders {}",
                      level + 1, std::exp(deviation), listed(result_.pairwise)));
    };
    const auto off = [&](std::size_t i) {
      return std::log(all_[i].error / std::abs(result_.corrected.at(all_[i].variable)));
    };
    // A pre-asymptotic range is a range: two levels or more, the coarsest of them off the most. One alone is an
    // outlier.
    if (first == 1 || (first > 1 && std::abs(off(0)) < std::abs(off(first - 1))))
      return named(first - 1, off(first - 1));
    if (const auto outlier = find_outlier(inside_)) return named(first + outlier->level, outlier->deviation);
    return std::nullopt;
  }

  Answer dwindles() const {
    if (theory_ == 0.0 || !falling() || approaching()) return std::nullopt;
    if (!(last_ < 0.25 * pairwise_.front()) && !has_floor()) return std::nullopt;
    return Conclusion{
        Verdict::stagnates,
        has_floor() ? fmt::format("the error stops falling: pairwise orders {}, and error = C v^{:.2f} + {:.3g} fits",
                                  pairs(), result_.floored.order, result_.floored.F)
                    : fmt::format("the error stops falling at {:.3g}: pairwise orders {}", all_.back().error, pairs())};
  }

  Answer wavers() const {
    const auto growing = std::find_if(pairwise_.begin(), pairwise_.end(), [](double order) { return order < 0.0; });
    if (growing == pairwise_.end()) return std::nullopt;
    const auto level = result_.window.first + static_cast<std::size_t>(growing - pairwise_.begin()) + 1;
    return inconclusive(
        fmt::format("the error grows from level {} to level {}: pairwise orders {}", level, level + 1, pairs()));
  }

  Answer agrees_with_theory() const {
    if (!near(result_.fitted.order)) return std::nullopt;
    if (!(result_.fitted.half_width() <= widest_half_width)) {
      return inconclusive(fmt::format("the interval of {} is too wide to judge; pairwise {}", estimates(), pairs()));
    }
    if (std::abs(result_.leave_one_out.change) > extrapolation_tolerance) {
      return inconclusive(fmt::format("{} hangs on level {}: without it the order changes by {:+.2f}; pairwise {}",
                                      estimates(), result_.leave_one_out.level + 1, result_.leave_one_out.change,
                                      pairs()));
    }
    const std::size_t n = inside_.size();
    const double scatter = std::sqrt(2.0 * result_.fitted.residual / static_cast<double>(n - 2)) /
                           std::log(inside_[n - 2].variable / inside_[n - 1].variable);
    const bool by_chance = std::abs(last_ - theory_) <= std::min(2.0 * scatter, widest_scatter) && !leaving();
    const bool extrapolates_elsewhere = result_.corrected.low > theory_ + extrapolation_tolerance ||
                                        result_.corrected.high < theory_ - extrapolation_tolerance;
    if (extrapolates_elsewhere || (!near(last_) && !by_chance)) return std::nullopt;
    return Conclusion{Verdict::confirmed,
                      fmt::format("{} agrees with theory's {:g}; pairwise {}", estimates(), theory_, pairs())};
  }

  /// The pairwise orders pass theory's and go on: a drift that looks like scatter about a straight line.
  bool leaving() const {
    return pairwise_.size() > 2 && !near(last_) && (falling() || std::is_sorted(pairwise_.begin(), pairwise_.end()));
  }

  Answer moves_toward_theory() const {
    const bool sharp = result_.corrected.contains(theory_) &&
                       result_.corrected.half_width() <= extrapolation_tolerance &&
                       std::abs(last_ - theory_) < std::abs(pairwise_.front() - theory_);
    if (!approaching() && !sharp) return std::nullopt;
    if (inside_.size() < 4) {
      return inconclusive(fmt::format("pairwise orders {} move toward {:g}; to extrapolate them takes a fourth level",
                                      pairs(), theory_));
    }
    const CorrectedLaw correction = fit_correction_of(inside_, theory_);
    const bool fits_as_well = correction.residual <= result_.corrected.residual;
    if (correction.q < slowest_correction) {
      if (!fits_as_well) return std::nullopt;
      return inconclusive(
          fmt::format("pairwise orders {} drift toward {:g} more slowly than by any correction v^q with q >= {:g}; {}",
                      pairs(), theory_, slowest_correction, estimates()));
    }
    if (std::abs(result_.extrapolated - theory_) > extrapolation_tolerance && !fits_as_well) return std::nullopt;
    return Conclusion{
        Verdict::pre_asymptotic,
        fmt::format("pairwise orders {} move toward {:g} like v^{:.2g} and extrapolate to {}{}; the power law's {} "
                    "is not there yet",
                    pairs(), theory_, correction.q, with_interval(result_.corrected), window(),
                    with_interval(result_.fitted))};
  }

  Conclusion departs() const {
    const bool one_side = std::all_of(pairwise_.begin(), pairwise_.end(), [&](double order) {
      return !near(order) && (order > theory_) == (last_ > theory_);
    });
    const bool extrapolated = result_.corrected.low > theory_ || result_.corrected.high < theory_;
    // Where scatter hides an approach, a correction of theory's order fits better than another order.
    const bool fitted = !result_.fitted.contains(theory_) && one_side && !approaching() &&
                        result_.fitted.residual < residual_of_order(inside_, theory_);
    if (!extrapolated && !fitted) {
      return inconclusive(fmt::format("{} neither agrees with theory's {:g} nor excludes it; pairwise {}", estimates(),
                                      theory_, pairs()));
    }
    const double distance = (extrapolated ? result_.corrected.order : result_.fitted.order) - theory_;
    return {distance < 0.0 ? Verdict::below : Verdict::above,
            fmt::format("{}, theory says {:g}; pairwise {}", estimates(), theory_, pairs())};
  }

  LevelView all_, inside_;
  double theory_;
  const Judgement& result_;
  std::span<const double> pairwise_;
  double last_;
};

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

Judgement judge(std::span<const Level> levels, double theory_order, const JudgeOptions& options) {
  Judgement result;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    result.pairwise.push_back(std::log(levels[i - 1].error / levels[i].error) /
                              std::log(levels[i - 1].variable / levels[i].variable));
  }
  result.window = {0, levels.empty() ? 0 : levels.size() - 1};
  std::optional<Conclusion> conclusion =
      unusable(levels, std::max(options.floor.value_or(0.0), round_off * options.scale.value_or(1.0)));
  const bool positive = std::all_of(levels.begin(), levels.end(), [](const Level& level) { return level.error > 0.0; });
  if (!conclusion || (conclusion->verdict == Verdict::floor && positive)) estimate(levels, result);
  if (!conclusion) conclusion = Evidence(levels, theory_order, result).conclude();
  result.verdict = conclusion->verdict;
  result.reason = std::move(conclusion->reason);
  return result;
}

Judgement judge(std::span<const Level> levels, double theory_order) { return judge(levels, theory_order, {}); }

}  // namespace acstudy
