#include "reports/fits.hpp"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>
#include <gsl/gsl_multifit.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/roots.hpp>
#include <memory>
#include <vector>

#include "mms/gsl_status.hpp"

namespace acstudy {

namespace {

constexpr double confidence = 0.95;

/// Levels as the fits need them: logarithms, and the variable relative to the coarsest level.
struct Logarithms {
  std::vector<double> v, e, weight, ratio;

  explicit Logarithms(LevelView levels) {
    for (const Level& level : levels) {
      v.push_back(std::log(level.variable));
      e.push_back(std::log(level.error));
      weight.push_back(level.weight);
      ratio.push_back(level.variable / levels.front().variable);
    }
  }
  std::size_t size() const { return v.size(); }
};

/// Weighted least-squares line; variance of the slope for errors of unit variance over weight.
struct Line {
  double intercept, slope, slope_variance, residual;
};

Line fit_line(const std::vector<double>& x, const std::vector<double>& weight, const std::vector<double>& y) {
  double intercept, slope, cov00, cov01, cov11, residual;
  gsl_fit_wlinear(x.data(), 1, weight.data(), 1, y.data(), 1, x.size(), &intercept, &slope, &cov00, &cov01, &cov11,
                  &residual);
  return {intercept, slope, cov11, residual};
}

struct Minimum {
  double at, value;
};

/// Lowest value on [first, last]: a scan, for there may be several minima, then Brent around the best.
template <class Function>
Minimum minimize(Function function, double first, double last, int cells) {
  const auto at = [&](int i) { return first + (last - first) * i / cells; };
  int best = 0;
  double lowest = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= cells; ++i) {
    if (const double value = function(at(i)); value < lowest) {
      lowest = value;
      best = i;
    }
  }
  std::uintmax_t iterations = 60;
  const auto [x, value] = boost::math::tools::brent_find_minima(function, at(std::max(best - 1, 0)),
                                                                at(std::min(best + 1, cells)), 40, iterations);
  return {x, value};
}

// The corrected law is fitted over z = log(1 + D v_0^q), v_0 the coarsest level: every z keeps 1 + D v^q positive on
// all levels. Beyond the bounds, D v_0^q = -0.95 and 3, the second term is no correction: as D grows the law turns into
// a power law of order p + q, which fits as well as a small D does and means nothing.
constexpr double lowest_z = -3.0, highest_z = 1.386;

/// The corrected law at a given correction: what is left is a line.
class Correction {
 public:
  Correction(const Logarithms& logs, double q) : logs_(logs), corrected_(logs.e) {
    for (const double ratio : logs.ratio) power_.push_back(std::pow(ratio, q));
  }

  Line line(double z) const {
    remove(z, 0.0);
    return fit_line(logs_.v, logs_.weight, corrected_);
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

}  // namespace

double student(double probability, std::size_t degrees_of_freedom) {
  return gsl_cdf_tdist_Pinv((1.0 + probability) / 2.0, static_cast<double>(degrees_of_freedom));
}

bool significant(double before, double after, std::size_t degrees_of_freedom, double level) {
  const double t = student(1.0 - level, degrees_of_freedom);
  return (before - after) * static_cast<double>(degrees_of_freedom) > t * t * after;
}

PowerLaw fit_power_law(LevelView levels) {
  PowerLaw fit;
  if (levels.size() < 3) return fit;
  const Logarithms logs(levels);
  const Line line = fit_line(logs.v, logs.weight, logs.e);
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
  CorrectedLaw fit;
  if (levels.size() < 4) return fit;
  const Logarithms logs(levels);
  const Correction correction(logs, q);
  const Minimum best = minimize([&](double z) { return correction.line(z).residual; }, lowest_z, highest_z, 24);
  const Line line = correction.line(best.at);
  fit.order = line.slope;
  fit.C = std::exp(line.intercept);
  fit.D = std::expm1(best.at) / std::pow(levels.front().variable, q);
  fit.q = q;
  fit.residual = line.residual;
  return fit;
}

CorrectedLaw fit_corrected_law(LevelView levels, double q) {
  CorrectedLaw fit = fit_corrected_law_only(levels, q);
  if (levels.size() < 4) return fit;
  const Logarithms logs(levels);
  const Correction correction(logs, q);
  const std::size_t free = levels.size() - 3;
  const double t = student(confidence, free);
  const double bound = fit.residual * (1.0 + t * t / static_cast<double>(free));
  const double z = std::log1p(fit.D * std::pow(levels.front().variable, q));
  const auto residual = [&](double trial) { return correction.line(trial).residual; };
  // At each z the orders within the bound are an interval around the line's slope; the profile's is their union. The
  // slope falls as z grows, so the lower end lies at larger z than the best fit and the upper end at smaller z.
  const auto end = [&](double sign, double z_end) {
    const auto reach = [&](double trial) {
      const Line line = correction.line(trial);
      return -sign * line.slope - std::sqrt(std::max(bound - line.residual, 0.0) * line.slope_variance);
    };
    return -sign * minimize(reach, std::min(z, z_end), std::max(z, z_end), 6).value;
  };
  fit.low = end(-1.0, boundary(residual, z, highest_z, bound));
  fit.high = end(1.0, boundary(residual, z, lowest_z, bound));
  return fit;
}

CorrectedLaw fit_corrected_law_and_q(LevelView levels) {
  CorrectedLaw fit;
  if (levels.size() < 5) return fit;
  const Logarithms logs(levels);
  const auto residual_at = [&](double log_q) {
    const Correction correction(logs, std::exp(log_q));
    return minimize([&](double z) { return correction.line(z).residual; }, lowest_z, highest_z, 12).value;
  };
  const double q = std::exp(minimize(residual_at, std::log(0.25), std::log(3.0), 8).at);
  fit = fit_corrected_law_only(levels, q);

  const std::size_t n = levels.size(), parameters = 4;
  using Matrix = std::unique_ptr<gsl_matrix, decltype(&gsl_matrix_free)>;
  using Vector = std::unique_ptr<gsl_vector, decltype(&gsl_vector_free)>;
  const Matrix derivatives(gsl_matrix_alloc(n, parameters), gsl_matrix_free),
      covariance(gsl_matrix_alloc(parameters, parameters), gsl_matrix_free);
  const Vector weights(gsl_vector_alloc(n), gsl_vector_free), misfit(gsl_vector_alloc(n), gsl_vector_free),
      step(gsl_vector_alloc(parameters), gsl_vector_free);
  const double D = fit.D * std::pow(levels.front().variable, q);
  for (std::size_t i = 0; i < n; ++i) {
    const double power = std::pow(logs.ratio[i], q), share = power / (1.0 + D * power);
    gsl_matrix_set(derivatives.get(), i, 0, 1.0);
    gsl_matrix_set(derivatives.get(), i, 1, std::log(logs.ratio[i]));
    gsl_matrix_set(derivatives.get(), i, 2, share);
    gsl_matrix_set(derivatives.get(), i, 3, D * share * std::log(logs.ratio[i]));
    gsl_vector_set(weights.get(), i, logs.weight[i]);
    gsl_vector_set(misfit.get(), i, logs.e[i] - std::log(fit.at(levels[i].variable)));
  }
  const std::unique_ptr<gsl_multifit_linear_workspace, decltype(&gsl_multifit_linear_free)> workspace(
      gsl_multifit_linear_alloc(n, parameters), gsl_multifit_linear_free);
  double residual;
  gsl_multifit_wlinear(derivatives.get(), weights.get(), misfit.get(), step.get(), covariance.get(), &residual,
                       workspace.get());
  const std::size_t free = n - parameters;
  const double half_width = student(confidence, free) * std::sqrt(gsl_matrix_get(covariance.get(), 1, 1) *
                                                                  fit.residual / static_cast<double>(free));
  fit.low = fit.order - half_width;
  fit.high = fit.order + half_width;
  return fit;
}

CorrectedLaw fit_correction_of(LevelView levels, double order) {
  CorrectedLaw fit;
  if (levels.size() < 4) return fit;
  const Logarithms logs(levels);
  const auto best_at = [&](double log_q) {
    const Correction correction(logs, std::exp(log_q));
    return minimize([&](double z) { return correction.residual(z, order); }, lowest_z, highest_z, 24);
  };
  fit.q = std::exp(minimize([&](double log_q) { return best_at(log_q).value; }, std::log(0.05), std::log(4.0), 16).at);
  const Minimum best = best_at(std::log(fit.q));
  fit.order = order;
  fit.D = std::expm1(best.at) / std::pow(levels.front().variable, fit.q);
  fit.residual = best.value;
  double sum = 0.0, mean = 0.0;
  for (const Level& level : levels) {
    const double law = std::pow(level.variable, order) * (1.0 + fit.D * std::pow(level.variable, fit.q));
    sum += level.weight;
    mean += (std::log(level.error / law) - mean) * level.weight / sum;
  }
  fit.C = std::exp(mean);
  return fit;
}

double residual_of_order(LevelView levels, double order) {
  if (levels.size() < 3) return not_estimated;
  const Logarithms logs(levels);
  const Correction correction(logs, 1.0);
  return minimize([&](double z) { return correction.residual(z, order); }, lowest_z, highest_z, 24).value;
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
    return fit_line(x, weight, y);
  };
  const auto residual = [&](double log_p) { return solve(std::exp(log_p)).residual; };
  const double lowest = std::log(0.05), highest = std::log(20.0);
  const Minimum best = minimize(residual, lowest, highest, 24);
  const Line line = solve(std::exp(best.at));
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
