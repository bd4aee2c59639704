#include "reports/judging/window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "reports/judging/orders.hpp"

namespace acstudy {

namespace {

constexpr double rejection = 0.002;

std::vector<Level> without(LevelView levels, std::size_t left_out) {
  std::vector<Level> rest(levels.begin(), levels.end());
  rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(left_out));
  return rest;
}

/// True if a level that is off by this much, in logarithms, moves the order between two levels out of tolerance.
/// Below that a deviation does not matter, however sharply exact errors show it.
bool matters(double deviation, double refinement) {
  return std::abs(deviation) > order_tolerance * std::abs(std::log(refinement));
}

bool matters(LevelView levels, const CorrectedLaw& law) {
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const std::size_t j = i > 0 ? i - 1 : 1;
    if (matters(std::log(levels[i].error / law.at(levels[i].variable)), levels[j].variable / levels[i].variable)) {
      return true;
    }
  }
  return false;
}

/// Scatter that does not matter, however sharply exact errors show it, and how much is known of it.
constexpr double harmless_scatter = 0.003, freedom = 1.0;
/// Density of the logarithm of an error that no law predicts: anything within a factor of e^2 or so.
constexpr double density_off_law = 0.5;

/// Logarithm of the probability of the errors of a window given that a corrected law holds there, up to what windows of
/// all sizes share: scatter is integrated out, with an inverse gamma density about what does not matter.
double evidence(double residual, std::size_t levels) {
  const double free = static_cast<double>(levels - 3);
  const double before = freedom * harmless_scatter * harmless_scatter;
  return std::lgamma(0.5 * (freedom + free)) - std::lgamma(0.5 * freedom) - 0.5 * free * std::log(M_PI) +
         0.5 * freedom * std::log(before) - 0.5 * (freedom + free) * std::log(before + residual);
}

}  // namespace

Window asymptotic_window(LevelView levels) {
  const std::size_t n = levels.size();
  if (n <= 4) return {0, n - 1};
  std::size_t best = 0;
  double highest = -std::numeric_limits<double>::infinity();
  for (std::size_t first = 0; first + 4 <= n; ++first) {
    const double residual = fit_corrected_law_only(levels.subspan(first)).residual;
    const double value = evidence(residual, n - first) + static_cast<double>(first) * std::log(density_off_law);
    if (value > highest) {
      highest = value;
      best = first;
    }
  }
  return {best, n - 1};
}

std::optional<Outlier> find_outlier(LevelView levels) {
  const std::size_t n = levels.size();
  if (n < 4) return std::nullopt;
  // Where the law passes close to every level there is none; that law may have its exponent q fitted.
  if (n > 4 && !matters(levels, fit_corrected_law_only(levels))) return std::nullopt;
  const std::size_t parameters = n == 4 ? 2 : 3;
  const auto law_of = [&](LevelView some) {
    if (parameters == 3) return fit_corrected_law_only(some);
    const PowerLaw line = fit_power_law(some);
    return CorrectedLaw{{line.order, line.low, line.high}, line.C, 0.0, 1.0, line.residual};
  };
  const double all = law_of(levels).residual;
  std::optional<Outlier> found;
  double lowest = all;
  for (std::size_t i = 0; i < n; ++i) {
    const std::vector<Level> rest = without(levels, i);
    const CorrectedLaw law = law_of(rest);
    const double expected = law.at(levels[i].variable);
    if (!(law.residual < lowest) || !(expected > 0.0)) continue;
    lowest = law.residual;
    const double deviation = std::log(levels[i].error / expected);
    const std::size_t j = i > 0 ? i - 1 : 1;
    found.reset();
    // A coarsest level that is off by little is pre-asymptotic, and no outlier.
    if ((i > 0 || std::abs(deviation) > std::log(harmless_factor)) &&
        matters(deviation, levels[j].variable / levels[i].variable) &&
        significant(all, law.residual, n - 1 - parameters, rejection / static_cast<double>(n))) {
      found = {i, deviation};
    }
  }
  return found;
}

LeaveOneOut leave_one_out(LevelView levels) {
  LeaveOneOut largest;
  if (levels.size() < 4) return largest;
  const double order = fit_power_law(levels).order;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double change = fit_power_law(without(levels, i)).order - order;
    if (i == 0 || std::abs(change) > std::abs(largest.change)) largest = {change, i};
  }
  return largest;
}

}  // namespace acstudy
