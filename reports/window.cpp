#include "reports/window.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <vector>

#include "reports/orders.hpp"

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

CorrectedLaw fit_law(LevelView levels) {
  const CorrectedLaw fixed = fit_corrected_law_only(levels);
  if (levels.size() < 6) return fixed;
  // No correction, no exponent of it; this also saves most of the time.
  if (!significant(fit_power_law(levels).residual, fixed.residual, levels.size() - 3, 0.05)) return fixed;
  const CorrectedLaw fitted = fit_corrected_law_and_q(levels);
  return significant(fixed.residual, fitted.residual, levels.size() - 4, 0.01) ? fitted : fixed;
}

}  // namespace

Asymptotics asymptotic_window(LevelView levels) {
  const std::size_t n = levels.size();
  std::size_t first = n > 4 ? n - 4 : 0, parameters = 3;
  CorrectedLaw law = fit_corrected_law_only(levels.subspan(first));
  for (; first > 0; --first) {
    const LevelView inside = levels.subspan(first), extended = levels.subspan(first - 1);
    CorrectedLaw wider = parameters == 3 ? fit_corrected_law_only(extended) : fit_corrected_law_and_q(extended);
    const Level& coarse = extended.front();
    const double expected = law.at(coarse.variable);
    const bool off =
        !(expected > 0.0) || matters(std::log(coarse.error / expected), coarse.variable / inside.front().variable);
    if (off && significant(wider.residual, law.residual, inside.size() - parameters, rejection)) {
      if (parameters == 4 || extended.size() < 6) break;
      // It may be the correction that has another exponent, if with it the wider window fits as well.
      const double free = static_cast<double>(extended.size() - 4);
      wider = fit_corrected_law_and_q(extended);
      if (wider.residual > gsl_cdf_fdist_Pinv(0.95, free, free) * law.residual) break;
      parameters = 4;
    }
    law = wider;
  }
  return {{first, n - 1}, parameters == 4 ? law : fit_law(levels.subspan(first))};
}

std::optional<Outlier> find_outlier(LevelView levels) {
  const std::size_t n = levels.size();
  if (n < 4) return std::nullopt;
  // Where the law passes close to every level there is none; that law may have its exponent q fitted.
  if (n > 4 && !matters(levels, fit_law(levels))) return std::nullopt;
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
    if (matters(deviation, levels[j].variable / levels[i].variable) &&
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
