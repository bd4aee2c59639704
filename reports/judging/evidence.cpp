#include "reports/judging/evidence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace acstudy {

namespace {

/// What does not fall below this may be round-off of a solution of size one, and of an error of this size at the
/// coarsest level.
constexpr double possible_round_off = 1e-10;
/// A growth of the error by this factor, faster than by this power of the variable, is an instability and no order.
constexpr double explosion_factor = 10.0, explosion_power = 4.0;
/// Corrections v^q with a smaller q cannot be told from logarithms.
constexpr double slowest_correction = 0.4;

/// An error that falls with a higher order than this has not stopped falling.
constexpr double slowest_fall = 0.45;
/// Pairwise orders this close to those of a law are taken to follow it.
constexpr double closest_following = 0.02;
/// A verdict against theory must not be wrong more often than this.
constexpr double firm_miss = 0.01, firm_level = 0.02;
/// An order that does not drift and is farther than this from theory's is another order, not scatter.
constexpr double clear_distance = 0.4;
/// Corrections that leave the order at theory's fit well enough if their squares are below this multiple of a line's.
constexpr double hint_ratio = 2.0;
/// Orders that still fall by more than this from level to level have not settled on a lower one.
constexpr double widest_fall = 1.0;

/// A last pairwise order farther off than this is no scatter.
constexpr double widest_scatter = 0.25;

std::string listed(std::span<const double> orders) {
  std::string text;
  for (const double order : orders) text += fmt::format("{}{:.2f}", text.empty() ? "" : ", ", order);
  return text;
}

std::string with_interval(const Estimate& estimate) {
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", estimate.order, estimate.low, estimate.high);
}

/// What finite, positive errors show whatever order theory gives, and what it needs to know of theory.
class Evidence {
 public:
  Evidence(LevelView levels, double theory, const Judgement& result, const JudgeOptions& options)
      : all_(levels),
        inside_(levels.subspan(result.window.first)),
        theory_(theory),
        result_(result),
        options_(options),
        pairwise_(std::span(result.pairwise).subspan(result.window.first)),
        last_(pairwise_.back()) {}

  Conclusion conclude() const {
    for (const auto question : {&Evidence::explodes, &Evidence::settles, &Evidence::grows, &Evidence::stops,
                                &Evidence::has_outlier, &Evidence::dwindles, &Evidence::wavers}) {
      if (auto answer = (this->*question)()) return *answer;
    }
    if (std::isnan(theory_)) return without_theory();
    for (const auto question : {&Evidence::agrees_with_theory, &Evidence::moves_toward_theory}) {
      if (auto answer = (this->*question)()) return *answer;
    }
    return departs();
  }

 private:
  using Answer = std::optional<Conclusion>;

  static bool by_error(const Level& a, const Level& b) { return a.error < b.error; }

  static Conclusion inconclusive(std::string reason) { return {Verdict::inconclusive, std::move(reason)}; }

  std::string pairs() const { return listed(pairwise_); }

  std::string window() const {
    if (result_.window.first == 0) return "";
    const std::size_t first = result_.window.first;
    return fmt::format(", levels {} to {} ({} not follow their law)", first + 1, all_.size(),
                       first == 1 ? "level 1 does" : fmt::format("levels 1 to {} do", first));
  }

  /// Names the coarsest level where its order to the next is of another kind than all others, which agree.
  std::string coarsest_is_far() const {
    if (pairwise_.size() < 3) return "";
    const auto [least, most] = std::minmax_element(pairwise_.begin() + 1, pairwise_.end());
    const bool far = *most - *least <= 0.5 && std::abs(pairwise_.front() - 0.5 * (*least + *most)) > 1.0;
    return far ? fmt::format(" (level {} is far off the others)", result_.window.first + 1) : "";
  }

  std::string estimates() const {
    if (inside_.size() < 4) return fmt::format("order {}", with_interval(result_.fitted));
    return fmt::format("order {}, with a correction {}{}{}", with_interval(result_.fitted),
                       with_interval(result_.corrected), window(), coarsest_is_far());
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

  /// Most of the finest error is a floor: the errors hardly fall any more, and the law with a floor, which lies below
  /// the finest error, explains them better than a correction and a power do.
  bool has_floor() const {
    if (!(last_ < slowest_fall)) return false;
    const double share = result_.floored.F / all_.back().error;
    return share > 0.5 && share <= 1.0 &&
           (result_.corrected.high < 0.5 * slowest_fall ||
            (result_.corrected.order < 0.0 && last_ < 0.5 * slowest_fall) ||
            explains_more(inside_, result_.corrected.residual, result_.floored.residual, 3, 0.05)) &&
           explains_more(inside_, result_.fitted.residual, result_.floored.residual, 3, 0.05);
  }

  /// The orders of the levels drift by more than chance explains.
  bool drifts() const {
    return inside_.size() >= 4 && explains_more(inside_, result_.fitted.residual, result_.corrected.residual, 3, 0.05);
  }

  /// The finest errors still fall, and faster than one that settles.
  bool still_falls() const { return last_ >= slowest_fall; }

  /// The finest errors, which do not fall, are so small against the solution or the coarsest error that round-off
  /// explains it.
  bool at_round_off() const {
    const double largest = std::max_element(all_.begin(), all_.end(), by_error)->error;
    const double bound = possible_round_off * options_.scale.value_or(largest);
    return std::all_of(all_.end() - 2, all_.end(), [&](const Level& level) { return level.error <= bound; });
  }

  Conclusion floored() const {
    return {Verdict::floor,
            fmt::format("the error stops falling at {:.2g}, which is round-off of {} of {:.2g}; pairwise orders {}",
                        all_.back().error, options_.scale ? "a solution" : "a coarsest error",
                        options_.scale.value_or(std::max_element(all_.begin(), all_.end(), by_error)->error),
                        listed(result_.pairwise))};
  }

  Answer explodes() const {
    const auto smallest = std::min_element(all_.begin(), all_.end(), by_error);
    const double growth = all_.back().error / smallest->error;
    const double power = std::log(growth) / std::log(smallest->variable / all_.back().variable);
    if (!(growth > explosion_factor && power > explosion_power)) return std::nullopt;
    return Conclusion{Verdict::unstable,
                      fmt::format("the error grows from {:.2g} to {:.2g}, like the variable to the power {:.1f}",
                                  smallest->error, all_.back().error, -power)};
  }

  Answer settles() const {
    if (theory_ != 0.0 || still_falls()) return std::nullopt;
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
    if (at_round_off()) return floored();
    // Growth from the first level on that follows no law is what round-off does too, and no scale tells them apart.
    const bool ever_fell = std::any_of(result_.pairwise.begin(), result_.pairwise.end(),
                                       [](double order) { return order > order_tolerance; });
    if (!ever_fell && !options_.scale && result_.fitted.half_width() > widest_half_width) {
      return inconclusive(fmt::format(
          "the errors grow from {:.2g} to {:.2g} by no law, pairwise orders {}; the solution's size would tell "
          "whether they are round-off or diverge",
          first, last, listed(result_.pairwise)));
    }
    return Conclusion{Verdict::diverges,
                      fmt::format("the error grows under refinement, from {:.2g} to {:.2g}: pairwise orders {}",
                                  twice ? all_[all_.size() - 3].error : first, last, pairs())};
  }

  Answer stops() const {
    const bool flat = std::abs(last_) <= order_tolerance && (falling() || result_.fitted.half_width() <= 1.0);
    const bool level =
        std::abs(result_.fitted.order) <= order_tolerance && result_.fitted.half_width() <= widest_half_width;
    if (theory_ == 0.0 || still_falls() || (!flat && !level)) return std::nullopt;
    if (at_round_off()) return floored();
    return Conclusion{Verdict::stagnates,
                      fmt::format("the error stops falling at {:.3g}: pairwise orders {}", all_.back().error, pairs())};
  }

  Conclusion outlier(std::size_t level, double deviation) const {
    return inconclusive(
        fmt::format("level {} lies off the law of the others by a factor of {:.3g}; run it again, or leave "
                    "it out if it is too coarse; pairwise orders {}",
                    level + 1, std::exp(deviation), listed(result_.pairwise)));
  }

  Answer has_outlier() const {
    const std::size_t first = result_.window.first;
    const auto off = [&](std::size_t i) {
      return std::log(all_[i].error / std::abs(result_.corrected.at(all_[i].variable)));
    };
    // A pre-asymptotic range is a range: two levels or more, the coarsest of them off the most, or one that is far off
    // or where the finer ones were heading. Any other is an outlier.
    const bool alone = first == 1 && std::abs(off(0)) < std::log(coarse_factor) && !drifts();
    const bool astray = first > 1 && std::abs(off(0)) < std::abs(off(first - 1));
    if ((alone || astray) && std::abs(off(first - 1)) > std::log(harmless_factor))
      return outlier(first - 1, off(first - 1));
    if (auto answer = coarsest_is_off()) return answer;
    if (const auto found = find_outlier(inside_)) {
      // Where every level departs no single one is to blame.
      if (departs_everywhere()) return std::nullopt;
      return outlier(first + found->level, found->deviation);
    }
    return std::nullopt;
  }

  bool departs_everywhere() const {
    const auto far = [&](double order, double side) { return (order - theory_) * side > clear_distance; };
    return theory_ > 0.0 &&
           (std::all_of(pairwise_.begin(), pairwise_.end(), [&](double order) { return far(order, 1.0); }) ||
            std::all_of(pairwise_.begin(), pairwise_.end(), [&](double order) { return far(order, -1.0); }));
  }

  /// The coarsest level alone does not follow the straight line of the finer ones: a correction that decays as fast as
  /// that explains anything, and may be an outlier.
  Answer coarsest_is_off() const {
    const LevelView rest = inside_.subspan(1);
    if (rest.size() < 4) return std::nullopt;
    const PowerLaw line = fit_power_law(rest);
    if (explains_more(rest, line.residual, fit_corrected_law_only(rest).residual, 3, 0.05)) return std::nullopt;
    const auto off = [&](std::size_t i) { return std::log(all_[i].error / line.at(all_[i].variable)); };
    const std::size_t first = result_.window.first;
    const double size = std::abs(off(first)), scatter = std::sqrt(line.residual / static_cast<double>(rest.size() - 2));
    if (size < std::log(harmless_factor) || size > std::log(coarse_factor) || size < 4.0 * scatter) return std::nullopt;
    const bool range = first > 0 && off(first - 1) * off(first) > 0.0 && std::abs(off(first - 1)) > size;
    if (range) return std::nullopt;
    return outlier(first, off(first));
  }

  Answer dwindles() const {
    const bool fades = falling() && last_ < 0.5 * slowest_fall && last_ < 0.5 * pairwise_.front() && !approaching();
    if (theory_ == 0.0 || (!has_floor() && !fades)) return std::nullopt;
    if (at_round_off()) return floored();
    if (!has_floor()) {
      return Conclusion{Verdict::stagnates, fmt::format("the error stops falling at {:.3g}: pairwise orders {}",
                                                        all_.back().error, pairs())};
    }
    return Conclusion{Verdict::stagnates,
                      fmt::format("the error stops falling: pairwise orders {}, and error = C v^{:.2f} + {:.3g} fits",
                                  pairs(), result_.floored.order, result_.floored.F)};
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
    if (drifts() && !(result_.fitted.half_width() <= widest_half_width)) return std::nullopt;
    if (!(result_.fitted.half_width() <= widest_half_width)) {
      return inconclusive(fmt::format("the interval of {} is too wide to judge; pairwise {}", estimates(), pairs()));
    }
    if (std::abs(result_.leave_one_out.change) > extrapolation_tolerance) {
      return inconclusive(fmt::format("{} hangs on level {}: without it the order changes by {:+.2f}; pairwise {}",
                                      estimates(), result_.leave_one_out.level + 1, result_.leave_one_out.change,
                                      pairs()));
    }
    // Where the orders drift, the last one is known better from the law than from two levels.
    const double finest = inside_.size() < 4 ? theory_
                                             : result_.corrected.order_between(inside_[inside_.size() - 2].variable,
                                                                               inside_.back().variable);
    const bool by_chance = std::abs(last_ - theory_) <= std::min(2.0 * scatter_of_last(), widest_scatter);
    const bool leaves =
        std::abs(finest - theory_) > (drifts() || !near(last_) ? order_tolerance : extrapolation_tolerance);
    const bool extrapolates_elsewhere = (result_.corrected.low > theory_ + extrapolation_tolerance ||
                                         result_.corrected.high < theory_ - extrapolation_tolerance) &&
                                        !follows(fit_correction_of(inside_, theory_));
    if (extrapolates_elsewhere || leaves || (!near(last_) && !by_chance)) return std::nullopt;
    return Conclusion{Verdict::confirmed,
                      fmt::format("{} agrees with theory's {:g}; pairwise {}", estimates(), theory_, pairs())};
  }

  /// Standard deviation of the last pairwise order, from what the levels scatter about a power law or are known to.
  double scatter_of_last() const {
    const std::size_t n = inside_.size();
    const Level &coarse = inside_[n - 2], &fine = inside_[n - 1];
    const double seen = std::sqrt(2.0 * (drifts() ? result_.corrected.residual / static_cast<double>(n - 3)
                                                  : result_.fitted.residual / static_cast<double>(n - 2)));
    return std::max(seen, std::hypot(coarse.noise, fine.noise)) / std::log(coarse.variable / fine.variable);
  }

  /// The levels fit theory's order with some correction as well as they fit any order.
  bool fits_theory(const CorrectedLaw& correction, double level = 0.05) const {
    return !explains_more(inside_, correction.residual, result_.corrected.residual, 3, level);
  }

  /// The pairwise orders are those of the law.
  bool follows(const CorrectedLaw& law) const {
    if (inside_.size() < 4 || law.q < slowest_correction) return false;
    for (std::size_t i = 0; i < pairwise_.size(); ++i) {
      const double order = law.order_between(inside_[i].variable, inside_[i + 1].variable);
      if (!(std::abs(pairwise_[i] - order) <= closest_following)) return false;
    }
    return true;
  }

  Answer moves_toward_theory() const {
    if (theory_ == 0.0 || !(std::abs(last_ - theory_) <= widest_scatter)) return std::nullopt;
    const bool nearer = std::abs(last_ - theory_) < std::abs(pairwise_.front() - theory_);
    const bool agrees = result_.corrected.contains(theory_) || near(result_.extrapolated);
    const bool at_end = near(last_) && near(result_.extrapolated);
    const bool sharp =
        agrees && nearer && result_.corrected.half_width() <= (at_end ? widest_half_width : extrapolation_tolerance);
    if (!approaching() && !sharp) return std::nullopt;
    if (inside_.size() < 4) {
      return inconclusive(fmt::format("pairwise orders {} move toward {:g}; to extrapolate them takes a fourth level",
                                      pairs(), theory_));
    }
    const CorrectedLaw correction = fit_correction_of(inside_, theory_);
    if (!fits_theory(correction) && !sharp) return std::nullopt;
    if (correction.q < slowest_correction && !sharp) {
      return inconclusive(fmt::format(
          "pairwise orders {} drift toward {:g} as slowly as v^{:.2g}, which a logarithm cannot be told from; {}",
          pairs(), theory_, correction.q, estimates()));
    }
    if (!agrees || (!near(last_) && std::abs(result_.extrapolated - theory_) > extrapolation_tolerance))
      return std::nullopt;
    // Few levels leave the interval wide; the way to theory's order may be sharp all the same.
    if (!(result_.corrected.half_width() <= widest_half_width) &&
        !(result_.window.first == 0 && approaching() && follows(correction))) {
      return inconclusive(
          fmt::format("pairwise orders {} move toward {:g}, but the interval of {} is too wide to judge", pairs(),
                      theory_, estimates()));
    }
    return Conclusion{
        Verdict::pre_asymptotic,
        fmt::format("pairwise orders {} move toward {:g} like v^{:.2g} and extrapolate to {}{}; the power law's {} "
                    "is not there yet",
                    pairs(), theory_, correction.q, with_interval(result_.corrected), window(),
                    with_interval(result_.fitted))};
  }

  /// The order is sharp, and so is its agreement with the finest levels.
  Conclusion without_theory() const {
    const bool sharp = result_.half_width() <= widest_half_width;
    const bool seen = std::abs(last_ - result_.order) <= widest_half_width;
    if (sharp && seen) {
      return {Verdict::determined,
              fmt::format("{}; pairwise {}; no theory's order was given to compare it with", estimates(), pairs())};
    }
    return inconclusive(fmt::format("the order is not determined: {}, pairwise {}", estimates(), pairs()));
  }

  /// Errors that are to settle fall, and no floor explains them as well as an order does.
  bool falls_without_floor() const {
    if (last_ < 0.5 * slowest_fall || 0.5 * (last_ + pairwise_[pairwise_.size() - 2]) < 0.8 * slowest_fall)
      return false;
    return !(result_.floored.F > 0.0) || result_.floored.F < 0.5 * all_.back().error ||
           explains_more(inside_, result_.floored.residual, result_.corrected.residual, 3, 0.05);
  }

  Conclusion departs() const {
    const double side = last_ - theory_;
    const auto beyond = [&](double order) { return (order - theory_) * side > 0.0; };
    const bool one_side = !near(last_) && beyond(drifts() ? result_.corrected.order : result_.fitted.order);
    const auto excludes = [&](const Estimate& e) {
      return std::isfinite(e.low) && !e.contains(theory_) && beyond(e.order);
    };
    const CorrectedLaw given = fit_usual_correction_of(inside_, theory_);
    const bool possible = inside_.size() >= 4 && fits_theory(given, firm_level);
    const bool straight = !drifts() && excludes(result_.fitted) &&
                          std::all_of(pairwise_.begin(), pairwise_.end(), beyond) &&
                          std::abs(result_.fitted.order - theory_) > clear_distance &&
                          !(given.residual < hint_ratio * result_.fitted.residual);
    const double margin = std::abs(result_.corrected.order - theory_),
                 reach = std::abs(last_ - result_.corrected.order);
    const bool bent = margin > std::max(order_tolerance, 0.5 * reach) && excludes(result_.corrected) &&
                      excludes(fit_corrected_law(inside_, firm_miss)) && !possible;
    // The finest orders move toward theory's, beyond where the law says that they go: it does not describe the end.
    const double beyond_law = side < 0.0 ? last_ - result_.corrected.high : result_.corrected.low - last_;
    const double before = pairwise_[pairwise_.size() - 2];
    const bool unsettled = (drifts() && beyond_law > scatter_of_last() && (last_ - before) * side < 0.0) ||
                           (drifts() && scatter_of_last() > widest_scatter) ||
                           (side < 0.0 && before - last_ > widest_fall);
    const bool away = departs_everywhere() &&
                      (side < 0.0 ? falling() : std::is_sorted(pairwise_.begin(), pairwise_.end())) &&
                      std::abs(last_ - pairwise_.front()) > extrapolation_tolerance;
    const bool firm = theory_ == 0.0 ? falls_without_floor() : one_side && !unsettled && (straight || bent || away);
    if (!firm) {
      return inconclusive(fmt::format("{} neither agrees with theory's {:g} nor excludes it; pairwise {}", estimates(),
                                      theory_, pairs()));
    }
    return {side < 0.0 ? Verdict::below : Verdict::above,
            fmt::format("{}, theory says {:g}; pairwise {}", estimates(), theory_, pairs())};
  }

  LevelView all_, inside_;
  double theory_;
  const Judgement& result_;
  const JudgeOptions& options_;
  std::span<const double> pairwise_;
  double last_;
};

}  // namespace

Conclusion conclude(LevelView levels, double theory_order, const Judgement& result, const JudgeOptions& options) {
  return Evidence(levels, theory_order, result, options).conclude();
}

}  // namespace acstudy
