#include "reports/judging/fits.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/roots.hpp>
#include <deque>
#include <map>
#include <vector>

#include "mms/gsl_status.hpp"

namespace acstudy {

namespace {

constexpr double confidence = 0.95;

/// Levels as the fits need them: logarithms, and the variable relative to the coarsest level.
struct Logarithms {
  std::vector<double> v, e, weight, ratio;
  WeightedLines lines;

  explicit Logarithms(LevelView levels) {
    for (const Level& level : levels) {
      v.push_back(std::log(level.variable));
      e.push_back(std::log(level.error));
      weight.push_back(level.weight);
      ratio.push_back(level.variable / levels.front().variable);
    }
    lines = {v, weight};
  }
  std::size_t size() const { return v.size(); }
};

struct Minimum {
  double at, value;
};

/// Lowest value on [first, last]: a scan, for there may be several minima, then Brent around each that shows.
template <class Function>
Minimum minimize(Function function, double first, double last, int cells) {
  const auto at = [&](int i) { return first + (last - first) * i / cells; };
  std::vector<double> values;
  for (int i = 0; i <= cells; ++i) {
    const double value = function(at(i));
    values.push_back(std::isnan(value) ? std::numeric_limits<double>::infinity() : value);
  }
  Minimum best{first, std::numeric_limits<double>::infinity()};
  for (int i = 0; i <= cells; ++i) {
    const auto here = values.begin() + i;
    if ((i > 0 && *(here - 1) < *here) || (i < cells && *(here + 1) <= *here)) continue;
    std::uintmax_t iterations = 60;
    const auto [x, value] = boost::math::tools::brent_find_minima(function, at(std::max(i - 1, 0)),
                                                                  at(std::min(i + 1, cells)), 40, iterations);
    if (value < best.value) best = {x, value};
  }
  return best;
}

// The corrected law is fitted over z = log(1 + D v_0^q), v_0 the coarsest level: every z keeps 1 + D v^q positive on
// all levels. Below the lower bound, D v_0^q = -0.95, the error would nearly vanish at the coarsest level. Above the
// upper one the second term is the larger by far even at the finest level: as D grows the law turns into a power law of
// order p + q, which fits as well as a small D does and means nothing.
constexpr double lowest_z = -3.0;
constexpr double largest_share_at_first = 3.0, largest_share_at_last = 1.0;
/// An order that the finest levels miss by less than this is what they show.
constexpr double order_shown = 0.1;

double highest_z(const Logarithms& logs, double q, double at_last = largest_share_at_last) {
  return std::log1p(std::max(largest_share_at_first, at_last * std::pow(logs.ratio.back(), -q)));
}

/// The corrected law with D and q given: in logarithms the rest is a line.
class Correction {
 public:
  Correction(const Logarithms& logs, double q) : logs_(logs), corrected_(logs.e) {
    for (const double ratio : logs.ratio) power_.push_back(std::pow(ratio, q));
  }

  FittedLine line(double z) const {
    remove(z, 0.0);
    return logs_.lines.through(corrected_);
  }

  /// Sum of squares with the order given too.
  double residual(double z, double order) const {
    remove(z, order);
    double sum = 0.0, mean = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      sum += logs_.weight[i];
      const double difference = corrected_[i] - mean;
      mean += difference * logs_.weight[i] / sum;
      squares += logs_.weight[i] * difference * (corrected_[i] - mean);
    }
    return squares;
  }

 private:
  void remove(double z, double order) const {
    const double D = std::expm1(z);
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      corrected_[i] = logs_.e[i] - std::log1p(D * power_[i]) - order * logs_.v[i];
    }
  }

  const Logarithms& logs_;
  std::vector<double> power_;
  mutable std::vector<double> corrected_;
};

/// The point farthest from `inside` toward `end` at which a function does not exceed `bound`. It may do so in between.
template <class Function>
double boundary(Function function, double inside, double end, double bound) {
  // Errors over hundreds of decades overflow; what cannot be evaluated is no fit.
  const auto excess = [&](double z) {
    const double value = function(z) - bound;
    return std::isnan(value) ? std::numeric_limits<double>::max() : value;
  };
  constexpr int cells = 12;
  double outer = end, at_outer = excess(end);
  if (!(at_outer > 0.0)) return end;
  for (int i = 1; i <= cells; ++i) {
    const double inner = i < cells ? end + (inside - end) * i / cells : inside;
    const double at_inner = excess(inner);
    if (!(at_inner < 0.0)) {
      outer = inner;
      at_outer = at_inner;
      continue;
    }
    std::uintmax_t iterations = 60;
    const bool rising = inner < outer;
    const auto bracket = boost::math::tools::toms748_solve(excess, std::min(inner, outer), std::max(inner, outer),
                                                           rising ? at_inner : at_outer, rising ? at_outer : at_inner,
                                                           boost::math::tools::eps_tolerance<double>(40), iterations);
    return rising ? bracket.first : bracket.second;
  }
  return inside;
}

/// Cells of a scan over z, in which a sum of squares has one minimum at most.
int cells(double highest) { return std::max(12, static_cast<int>(2.0 * (highest - lowest_z))); }

struct BestLaw {
  CorrectedLaw law;
  double z;
};

BestLaw best_law(const Logarithms& logs, double q, double v_0) {
  const Correction correction(logs, q);
  const double highest = highest_z(logs, q);
  const Minimum best =
      minimize([&](double z) { return correction.line(z).residual; }, lowest_z, highest, cells(highest));
  const FittedLine line = correction.line(best.at);
  CorrectedLaw fit;
  fit.order = line.slope;
  fit.C = std::exp(line.intercept);
  fit.D = std::expm1(best.at) / std::pow(v_0, q);
  fit.q = q;
  fit.residual = line.residual;
  return {fit, best.at};
}

/// The law with the order and q given.
CorrectedLaw law_of_order(const Logarithms& logs, double order, double q, double v_0) {
  const Correction correction(logs, q);
  const double highest = highest_z(logs, q, q / order_shown - 1.0);
  const Minimum best =
      minimize([&](double z) { return correction.residual(z, order); }, lowest_z, highest, cells(highest));
  CorrectedLaw law;
  law.order = order;
  law.q = q;
  law.D = std::expm1(best.at) / std::pow(v_0, q);
  law.residual = best.value;
  double sum = 0.0, mean = 0.0;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const double log_law = order * logs.v[i] + std::log1p(std::expm1(best.at) * std::pow(logs.ratio[i], q));
    sum += logs.weight[i];
    mean += (logs.e[i] - log_law - mean) * logs.weight[i] / sum;
  }
  law.C = std::exp(mean);
  return law;
}

/// All orders at which the sum of squares, minimized over C and D, does not exceed the bound.
Estimate profile(const Logarithms& logs, const BestLaw& best, double bound) {
  const Correction correction(logs, best.law.q);
  const auto residual = [&](double trial) { return correction.line(trial).residual; };
  // At each z the orders within the bound are an interval around the line's slope; the profile's is their union. The
  // slope falls as z grows, so the lower end lies at larger z than the best fit and the upper end at smaller z.
  const auto end = [&](double sign, double z_end) {
    const auto reach = [&](double trial) {
      const FittedLine line = correction.line(trial);
      return -sign * line.slope - std::sqrt(std::max(bound - line.residual, 0.0) * line.slope_variance);
    };
    return -sign * minimize(reach, std::min(best.z, z_end), std::max(best.z, z_end), 6).value;
  };
  return {best.law.order, end(-1.0, boundary(residual, best.z, highest_z(logs, best.law.q), bound)),
          end(1.0, boundary(residual, best.z, lowest_z, bound))};
}

/// Noise that is known beforehand weighs as much as if it had been seen in so many levels.
constexpr std::size_t known_freedom = 2;

double known_squares(LevelView levels) {
  double sum = 0.0;
  for (const Level& level : levels) sum += level.weight * level.noise * level.noise;
  return static_cast<double>(known_freedom) * sum / static_cast<double>(levels.size());
}

std::size_t freedom(LevelView levels, std::size_t parameters) {
  return levels.size() - parameters + (known_squares(levels) > 0.0 ? known_freedom : 0);
}

/// Exponents q that are united to an interval.
constexpr double united_exponents[] = {0.5, 1.0, 2.0, 3.0};
/// Steps of q in a search for the best one, and its ends.
constexpr double step_of_q = 0.5, largest_q = 6.0;

/// The corrected laws of a series by their q, each fitted once.
class Laws {
 public:
  explicit Laws(LevelView levels) : levels_(levels.begin(), levels.end()), logs_(levels) {}

  bool are_of(LevelView levels) const {
    return std::equal(levels.begin(), levels.end(), levels_.begin(), levels_.end(), [](const Level& a, const Level& b) {
      return a.variable == b.variable && a.error == b.error && a.weight == b.weight;
    });
  }
  const Logarithms& logs() const { return logs_; }

  const BestLaw& best(double q) {
    const auto known = by_q_.find(q);
    return known != by_q_.end() ? known->second
                                : by_q_.emplace(q, best_law(logs_, q, levels_.front().variable)).first->second;
  }

  /// The best of all exponents: of a few, then of the neighbors of the best.
  BestLaw best_of_all_exponents() {
    BestLaw found = best(1.0);
    const auto improve = [&](double q) {
      if (best(q).law.residual < found.law.residual) found = best(q);
    };
    for (const double q : {0.5, 2.0, 4.0, largest_q}) improve(q);
    const double middle = found.law.q;
    for (const double step : {-2.0, -1.0, 1.0, 2.0}) {
      const double q = middle + step * step_of_q;
      if (q >= step_of_q && q <= largest_q && q != 1.0 && q != 2.0 && q != 4.0) improve(q);
    }
    return found;
  }

 private:
  std::vector<Level> levels_;
  Logarithms logs_;
  std::map<double, BestLaw> by_q_;
};

/// Those of the levels. Judging a series asks for them over and over, for the same windows and with the same levels
/// left out, so the last are kept; a reference holds until the next call.
Laws& laws_of(LevelView levels) {
  thread_local std::deque<Laws> lately;
  constexpr std::size_t kept = 16;
  for (Laws& laws : lately) {
    if (laws.are_of(levels)) return laws;
  }
  if (lately.size() == kept) lately.pop_front();
  return lately.emplace_back(levels);
}

/// The orders drift if a correction explains so much that chance does so with this probability.
constexpr double drift_level = 0.02;

}  // namespace

WeightedLines::WeightedLines(std::span<const double> x, std::span<const double> weight)
    : weight_(weight.begin(), weight.end()), share_(x.size()), dx_(x.size()) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(weight_[i] > 0.0)) continue;
    total_ += weight_[i];
    share_[i] = weight_[i] / total_;
    mean_ += (x[i] - mean_) * share_[i];
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(weight_[i] > 0.0)) continue;
    dx_[i] = x[i] - mean_;
    square_ += (dx_[i] * dx_[i] - square_) * share_[i];
  }
}

FittedLine WeightedLines::through(std::span<const double> y) const {
  double mean = 0.0, product = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (weight_[i] > 0.0) mean += (y[i] - mean) * share_[i];
  }
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (weight_[i] > 0.0) product += (dx_[i] * (y[i] - mean) - product) * share_[i];
  }
  FittedLine line;
  line.slope = product / square_;
  line.intercept = mean - mean_ * line.slope;
  line.slope_variance = 1.0 / (total_ * square_);
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (!(weight_[i] > 0.0)) continue;
    const double miss = y[i] - mean - line.slope * dx_[i];
    line.residual += weight_[i] * miss * miss;
  }
  return line;
}

double student(double probability, std::size_t degrees_of_freedom) {
  return gsl_cdf_tdist_Pinv((1.0 + probability) / 2.0, static_cast<double>(degrees_of_freedom));
}

bool significant(double before, double after, std::size_t degrees_of_freedom, double level) {
  const double t = student(1.0 - level, degrees_of_freedom);
  return (before - after) * static_cast<double>(degrees_of_freedom) > t * t * after;
}

bool explains_more(LevelView levels, double before, double after, std::size_t parameters, double level) {
  const double known = known_squares(levels);
  return significant(before + known, after + known, freedom(levels, parameters), level);
}

PowerLaw fit_power_law(LevelView levels) {
  PowerLaw fit;
  if (levels.size() < 3) return fit;
  const Logarithms logs(levels);
  const FittedLine line = logs.lines.through(logs.e);
  const std::size_t free = levels.size() - 2;
  const double half_width =
      student(confidence, free) * std::sqrt(line.slope_variance * line.residual / static_cast<double>(free));
  fit.order = line.slope;
  fit.low = line.slope - half_width;
  fit.high = line.slope + half_width;
  fit.C = std::exp(line.intercept);
  fit.residual = line.residual;
  return fit;
}

CorrectedLaw fit_corrected_law_only(LevelView levels, double q) {
  if (levels.size() < 4) return {};
  return laws_of(levels).best(q).law;
}

CorrectedLaw fit_corrected_law_only(LevelView levels) {
  if (levels.size() < 4) return {};
  return laws_of(levels).best_of_all_exponents().law;
}

CorrectedLaw fit_corrected_law(LevelView levels, double miss) {
  if (levels.size() < 4) return {};
  Laws& laws = laws_of(levels);
  const BestLaw best = laws.best_of_all_exponents();
  CorrectedLaw united = best.law;
  united.low = united.high = united.order;
  const bool drift = explains_more(levels, fit_power_law(levels).residual, best.law.residual, 3, drift_level);
  const bool few = levels.size() == 4;
  const double part_of_miss = drift ? (few ? 1.5 : 1.2) : (few ? 2.6 : 2.2);
  const double t = student(1.0 - part_of_miss * miss, freedom(levels, 3)), free = freedom(levels, 3);
  const auto unite = [&](const BestLaw& one) {
    const double bound = one.law.residual + t * t * (one.law.residual + known_squares(levels)) / free;
    const Estimate own = profile(laws.logs(), one, bound);
    united.low = std::min(united.low, own.low);
    united.high = std::max(united.high, own.high);
  };
  unite(best);
  for (const double q : united_exponents) {
    if (q == best.law.q || (few && q > 2.0)) continue;
    const BestLaw& one = laws.best(q);
    if (!explains_more(levels, one.law.residual, best.law.residual, 3, 0.1 * miss)) unite(one);
  }
  return united;
}

CorrectedLaw fit_correction_of(LevelView levels, double order) {
  if (levels.size() < 4) return {};
  const Logarithms logs(levels);
  const auto at = [&](double log_q) { return law_of_order(logs, order, std::exp(log_q), levels.front().variable); };
  return at(minimize([&](double log_q) { return at(log_q).residual; }, std::log(0.05), std::log(largest_q), 16).at);
}

CorrectedLaw fit_usual_correction_of(LevelView levels, double order) {
  CorrectedLaw best;
  if (levels.size() < 4) return best;
  const Logarithms logs(levels);
  for (double q = step_of_q; q <= largest_q; q += step_of_q) {
    const CorrectedLaw law = law_of_order(logs, order, q, levels.front().variable);
    if (!(best.residual <= law.residual)) best = law;
  }
  return best;
}

FlooredLaw fit_floored_law(LevelView levels) {
  FlooredLaw fit;
  if (levels.size() < 4) return fit;
  // At a given p a line, error = F + C v^p, weighted by one over the squared error.
  const double v_0 = levels.front().variable, e_n = levels.back().error;
  const auto solve = [&](double p) {
    std::vector<double> x, y, weight;
    for (const Level& level : levels) {
      x.push_back(std::pow(level.variable / v_0, p));
      y.push_back(level.error / e_n);
      weight.push_back(level.weight / (y.back() * y.back()));
    }
    return WeightedLines(x, weight).through(y);
  };
  const auto residual = [&](double log_p) { return solve(std::exp(log_p)).residual; };
  const double lowest = std::log(0.05), highest = std::log(20.0);
  const Minimum best = minimize(residual, lowest, highest, 24);
  const FittedLine line = solve(std::exp(best.at));
  fit.order = std::exp(best.at);
  fit.C = line.slope * e_n / std::pow(v_0, fit.order);
  fit.F = line.intercept * e_n;
  fit.residual = line.residual;
  const std::size_t free = levels.size() - 3;
  const double t = student(confidence, free);
  const double bound = fit.residual * (1.0 + t * t / static_cast<double>(free));
  fit.low = std::exp(boundary(residual, best.at, lowest, bound));
  fit.high = std::exp(boundary(residual, best.at, highest, bound));
  return fit;
}

}  // namespace acstudy
