#include "reports/orders.hpp"

#include <fmt/format.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>

namespace acstudy {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

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
};

/// Errors of this size are round-off of a solution of order one, accumulated over a run.
constexpr double round_off = 1e-12;

struct Line {
  double slope, slope_variance, residual;  ///< residual: sum of squares
};

/// Least squares of log(error) over log(variable).
Line fit_line(const std::vector<double>& x, const std::vector<double>& y) {
  double intercept, slope, cov00, cov01, cov11, residual;
  gsl_fit_linear(x.data(), 1, y.data(), 1, x.size(), &intercept, &slope, &cov00, &cov01, &cov11, &residual);
  return {slope, cov11, residual};
}

/// p of error = C v^p (1 + D v / v_0), v_0 the coarsest level: for a given D a line in logarithms; D by a scan and
/// Brent's minimization.
double extrapolated_order(const std::vector<double>& log_v, const std::vector<double>& log_e) {
  const auto fit = [&](double D) {
    std::vector<double> corrected = log_e;
    for (std::size_t i = 0; i < corrected.size(); ++i) corrected[i] -= std::log1p(D * std::exp(log_v[i] - log_v[0]));
    return fit_line(log_v, corrected);
  };
  constexpr double lowest = -0.95, highest = 20.0;
  constexpr int cells = 60;
  const auto D_at = [&](int i) {
    return std::expm1(std::log1p(lowest) + (std::log1p(highest) - std::log1p(lowest)) * i / cells);
  };
  int best = 0;
  for (int i = 1; i <= cells; ++i) {
    if (fit(D_at(i)).residual < fit(D_at(best)).residual) best = i;
  }
  const auto [D, residual] =
      boost::math::tools::brent_find_minima([&](double trial) { return fit(trial).residual; },
                                            D_at(std::max(best - 1, 0)), D_at(std::min(best + 1, cells)), 40);
  return fit(D).slope;
}

std::string listed(const std::vector<double>& orders) {
  std::string text;
  for (const double order : orders) text += fmt::format("{}{:.2f}", text.empty() ? "" : ", ", order);
  return text;
}

/// Sets verdict and reason where the levels themselves allow no order.
bool judge_levels(std::span<const Level> levels, Judgement& result) {
  const auto conclude = [&](Verdict verdict, std::string reason) {
    result.verdict = verdict;
    result.reason = std::move(reason);
    return true;
  };
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (!std::isfinite(levels[i].error)) {
      return conclude(Verdict::unstable,
                      fmt::format("the error of level {} of {} is {}", i + 1, levels.size(), levels[i].error));
    }
  }
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (levels[i].error < 0.0) {
      return conclude(Verdict::inconclusive,
                      fmt::format("the error of level {} is negative: {:.3g}", i + 1, levels[i].error));
    }
    if (!(levels[i].variable > 0.0) || !std::isfinite(levels[i].variable)) {
      return conclude(Verdict::inconclusive, fmt::format("the variable of level {} is {:.3g}; it must be positive",
                                                         i + 1, levels[i].variable));
    }
    if (i > 0 && !(levels[i].variable < levels[i - 1].variable)) {
      return conclude(Verdict::inconclusive,
                      fmt::format("level {} does not refine level {}: the variable goes from {:.3g} to {:.3g}", i + 1,
                                  i, levels[i - 1].variable, levels[i].variable));
    }
  }
  if (levels.size() < 3) {
    return conclude(Verdict::inconclusive,
                    fmt::format("{} level(s); an order with an interval needs at least 3", levels.size()));
  }
  const auto smallest =
      std::min_element(levels.begin(), levels.end(), [](auto a, auto b) { return a.error < b.error; });
  const double first = levels.front().error, last = levels.back().error;
  if (last <= round_off) {
    return conclude(Verdict::floor, fmt::format("the finest error, {:.2g}, is round-off", last));
  }
  if (smallest->error == 0.0) {
    return conclude(Verdict::inconclusive, "an error is exactly zero, though finer levels are not");
  }
  // Algebraic growth is "diverges"; growth faster than any scheme's order is the signature of an instability.
  if (last > smallest->error) {
    const double growth = std::log(last / smallest->error) / std::log(smallest->variable / levels.back().variable);
    if (growth > 4.0) {
      return conclude(Verdict::unstable,
                      fmt::format("the error grows from {:.2g} to {:.2g}, like the variable to the power {:.1f}",
                                  smallest->error, last, -growth));
    }
    const double overall = std::log(first / last) / std::log(levels.front().variable / levels.back().variable);
    if (overall < -order_tolerance) {
      return conclude(Verdict::diverges,
                      fmt::format("the error grows from {:.2g} to {:.2g} under refinement", first, last));
    }
  }
  return false;
}

/// Sets verdict and reason for finite, positive, falling errors.
void judge_order(std::span<const Level> levels, double theory, Judgement& result) {
  const auto agrees = [&](double order) { return std::abs(order - theory) <= order_tolerance; };
  const auto& pairwise = result.pairwise;
  const double last = pairwise.back();
  const std::string fitted = fmt::format("order {:.2f} [{:.2f}, {:.2f}]", result.order, result.low, result.high);

  bool approaching = true;
  for (std::size_t i = 1; i < pairwise.size(); ++i) {
    approaching = approaching && std::abs(pairwise[i] - theory) < std::abs(pairwise[i - 1] - theory);
  }
  const auto conclude = [&](Verdict verdict, std::string reason) {
    result.verdict = verdict;
    result.reason = std::move(reason);
  };

  if (theory == 0.0) {
    if (std::abs(last) <= order_tolerance) {
      return conclude(Verdict::stagnates,
                      fmt::format("the error settles at {:.3g}, last pairwise order {:.2f}, as theory says",
                                  levels.back().error, last));
    }
    return conclude(Verdict::inconclusive,
                    fmt::format("the error has not settled: pairwise orders {}", listed(pairwise)));
  }
  const bool narrow = result.high - result.low <= 2.0;
  const bool falling = std::is_sorted(pairwise.rbegin(), pairwise.rend());
  const bool stops = last <= order_tolerance || last < 0.25 * *std::max_element(pairwise.begin(), pairwise.end());
  if (stops && (falling || narrow)) {
    return conclude(Verdict::stagnates, fmt::format("the error stops falling at {:.3g}: pairwise orders {}",
                                                    levels.back().error, listed(pairwise)));
  }
  if (!narrow && !approaching) {
    return conclude(Verdict::inconclusive,
                    fmt::format("{}: the interval is too wide to judge; pairwise orders {}", fitted, listed(pairwise)));
  }
  if (agrees(result.order) && agrees(last)) {
    return conclude(Verdict::confirmed,
                    fmt::format("{} and last pairwise order {:.2f} agree with theory's {:g}", fitted, last, theory));
  }
  if (approaching && std::abs(result.extrapolated - theory) <= extrapolation_tolerance) {
    return conclude(
        Verdict::pre_asymptotic,
        fmt::format("pairwise orders {} move toward {:g} and extrapolate to {:.2f}; the fitted {} is not there yet",
                    listed(pairwise), theory, result.extrapolated, fitted));
  }
  if (approaching && std::isnan(result.extrapolated)) {
    return conclude(Verdict::inconclusive,
                    fmt::format("pairwise orders {} move toward {:g}; to extrapolate them takes a fourth level",
                                listed(pairwise), theory));
  }
  const double distance = agrees(last) ? result.order - theory : last - theory;
  conclude(distance < 0.0 ? Verdict::below : Verdict::above,
           fmt::format("{}, theory says {:g}; pairwise orders {}, extrapolated {:.2f}", fitted, theory,
                       listed(pairwise), result.extrapolated));
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
  return verdict == expected || (expected == Verdict::confirmed && verdict == Verdict::pre_asymptotic);
}

Judgement judge(std::span<const Level> levels, double theory_order) {
  Judgement result{unknown, unknown, unknown, unknown, {}, Verdict::inconclusive, ""};
  for (std::size_t i = 1; i < levels.size(); ++i) {
    result.pairwise.push_back(std::log(levels[i - 1].error / levels[i].error) /
                              std::log(levels[i - 1].variable / levels[i].variable));
  }
  const bool judged = judge_levels(levels, result);

  const bool fittable = std::all_of(levels.begin(), levels.end(), [](const Level& level) {
    return std::isfinite(level.error) && level.error > 0.0 && std::isfinite(level.variable) && level.variable > 0.0;
  });
  if (fittable && levels.size() >= 3) {
    std::vector<double> log_v, log_e;
    for (const Level& level : levels) {
      log_v.push_back(std::log(level.variable));
      log_e.push_back(std::log(level.error));
    }
    if (*std::max_element(log_v.begin(), log_v.end()) > *std::min_element(log_v.begin(), log_v.end())) {
      const Line line = fit_line(log_v, log_e);
      const double t = gsl_cdf_tdist_Pinv(0.975, static_cast<double>(levels.size() - 2));
      const double half_width = t * std::sqrt(line.slope_variance);
      result.order = line.slope;
      result.low = line.slope - half_width;
      result.high = line.slope + half_width;
      if (levels.size() >= 4) result.extrapolated = extrapolated_order(log_v, log_e);
    }
  }
  if (!judged) judge_order(levels, theory_order, result);
  return result;
}

}  // namespace acstudy
