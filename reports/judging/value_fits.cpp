#include "reports/judging/value_fits.hpp"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_multifit.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <memory>

namespace acstudy {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double lowest_order = 0.05, highest_order = 20.0;
constexpr double smallest_correction = -0.95, largest_correction = 3.0;
/// Where its printed digits leave more than this share of its error open, a level weighs less.
constexpr double usual_scatter = 0.01;
constexpr double corrections[] = {0.5, 1.0, 2.0}, no_correction[] = {0.0};

/// What the scatter of the values is.
enum class Noise {
  digits,  ///< what their printed digits leave open, and nothing else
  errors,  ///< in proportion to their errors, or what digits leave open where that is more
};

/// Linear least squares at one p, in units of the coarsest variable and of the range of the values.
struct Line {
  double residual = infinity;  ///< made comparable between different p: the weights change with p
  double value = 0.0, C = 0.0, D = 0.0;
  double variance = 0.0;  ///< of `value`, for a `residual` of one per degree of freedom
};

class Profile {
 public:
  Profile(std::span<const Value> values, Noise noise)
      : n_(values.size()), noise_(noise), finest_(values.back().value), coarsest_(values.front().variable) {
    const auto [low, high] =
        std::minmax_element(values.begin(), values.end(), [](auto& a, auto& b) { return a.value < b.value; });
    range_ = high->value - low->value;
    for (const Value& value : values) {
      x_.push_back(value.variable / coarsest_);
      y_.push_back((value.value - finest_) / range_);
      digits_.push_back(value.digits / range_ / std::sqrt(3.0));
    }
    basis_[0].assign(n_, 1.0);
    for (std::size_t k = 2; k <= 3; ++k) {
      spaces_[k].columns.reset(gsl_matrix_alloc(n_, k));
      spaces_[k].covariance.reset(gsl_matrix_alloc(k, k));
      spaces_[k].solution.reset(gsl_vector_alloc(k));
      spaces_[k].workspace.reset(gsl_multifit_linear_alloc(n_, k));
    }
    weights_.reset(gsl_vector_alloc(n_));
    right_.reset(gsl_vector_alloc(n_));
    for (std::size_t i = 0; i < n_; ++i) gsl_vector_set(right_.get(), i, y_[i]);
  }

  /// The best fit with a correction of this exponent, or without one for q = 0.
  Line at(double p, double q) const {
    weigh(p);
    basis_[1].resize(n_);
    basis_[2].resize(n_);
    for (std::size_t i = 0; i < n_; ++i) {
      basis_[1][i] = std::pow(x_[i], p);
      basis_[2][i] = basis_[1][i] * std::pow(x_[i], q);
    }
    if (q == 0.0) return solve(2);
    Line line = solve(3);
    if (line.D >= smallest_correction && line.D <= largest_correction) return line;
    const std::vector<double> power = basis_[1];
    line.residual = infinity;
    for (const double D : {smallest_correction, largest_correction}) {
      for (std::size_t i = 0; i < n_; ++i) basis_[1][i] = power[i] + D * basis_[2][i];
      Line bounded = solve(2);
      bounded.D = D;
      if (bounded.residual < line.residual) line = bounded;
    }
    return line;
  }

  /// The residual per degree of freedom that printed digits alone make.
  double least(double p) const {
    weigh(p);
    double sum = 0.0;
    for (std::size_t i = 0; i < n_; ++i) sum += gsl_vector_get(weights_.get(), i) * digits_[i] * digits_[i];
    return sum / static_cast<double>(n_);
  }

  double value(double scaled) const { return finest_ + range_ * scaled; }
  double coefficient(double scaled, double p) const { return range_ * scaled * std::pow(coarsest_, -p); }
  double correction(double scaled, double q) const { return scaled * std::pow(coarsest_, -q); }

 private:
  struct Free {
    void operator()(gsl_matrix* matrix) const { gsl_matrix_free(matrix); }
    void operator()(gsl_vector* vector) const { gsl_vector_free(vector); }
    void operator()(gsl_multifit_linear_workspace* workspace) const { gsl_multifit_linear_free(workspace); }
  };
  template <class T>
  using Owned = std::unique_ptr<T, Free>;
  struct Space {
    Owned<gsl_matrix> columns, covariance;
    Owned<gsl_vector> solution;
    Owned<gsl_multifit_linear_workspace> workspace;
  };

  /// Weights of geometric mean one: then residuals at different p compare like likelihoods.
  void weigh(double p) const {
    double mean = 0.0;
    std::vector<double> logarithms(n_);
    for (std::size_t i = 0; i < n_; ++i) {
      const double deviation =
          noise_ == Noise::digits ? digits_[i] : std::hypot(std::pow(x_[i], p), digits_[i] / usual_scatter);
      logarithms[i] = -2.0 * std::log(deviation);
      mean += logarithms[i] / static_cast<double>(n_);
    }
    for (std::size_t i = 0; i < n_; ++i) gsl_vector_set(weights_.get(), i, std::exp(logarithms[i] - mean));
  }

  Line solve(std::size_t parameters) const {
    const Space& space = spaces_[parameters];
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t k = 0; k < parameters; ++k) gsl_matrix_set(space.columns.get(), i, k, basis_[k][i]);
    }
    Line line;
    gsl_multifit_wlinear(space.columns.get(), weights_.get(), right_.get(), space.solution.get(),
                         space.covariance.get(), &line.residual, space.workspace.get());
    line.value = gsl_vector_get(space.solution.get(), 0);
    line.C = gsl_vector_get(space.solution.get(), 1);
    line.D = parameters == 3 ? gsl_vector_get(space.solution.get(), 2) / line.C : 0.0;
    line.variance = gsl_matrix_get(space.covariance.get(), 0, 0);
    if (!std::isfinite(line.residual)) line.residual = infinity;
    return line;
  }

  std::size_t n_;
  Noise noise_;
  double finest_, coarsest_, range_;
  std::vector<double> x_, y_, digits_;
  mutable std::vector<double> basis_[3];
  mutable Space spaces_[4];
  Owned<gsl_vector> weights_, right_;
};

/// The law with a correction of this exponent, or without one for q = 0.
struct Fitted {
  ValueLaw law;
  double residual, bound;  ///< the least one, and the largest within the interval
  bool explained;          ///< printed digits explain the residual
};

Fitted fit(const Profile& profile, std::size_t n, double q) {
  const std::size_t parameters = q == 0.0 ? 3 : 4;
  const auto residual = [&](double log_p) { return profile.at(std::exp(log_p), q).residual; };
  constexpr int cells = 48;
  const double first = std::log(lowest_order), last = std::log(highest_order);
  const auto place = [&](int i) { return first + (last - first) * i / cells; };

  // There may be several minima.
  std::vector<double> scan;
  for (int i = 0; i <= cells; ++i) scan.push_back(residual(place(i)));
  double best = first, smallest = infinity;
  for (std::size_t i = 0; i <= cells; ++i) {
    if ((i > 0 && scan[i - 1] < scan[i]) || (i < cells && scan[i + 1] < scan[i])) continue;
    const int cell = static_cast<int>(i);
    std::uintmax_t iterations = 80;
    const auto [log_p, value] = boost::math::tools::brent_find_minima(residual, place(std::max(cell - 1, 0)),
                                                                      place(std::min(cell + 1, cells)), 50, iterations);
    if (value < smallest) {
      smallest = value;
      best = log_p;
    }
  }
  const int lowest = static_cast<int>(std::lround((best - first) / (last - first) * cells));

  const Line line = profile.at(std::exp(best), q);
  ValueLaw law;
  law.order = std::exp(best);
  law.value = profile.value(line.value);
  law.C = profile.coefficient(line.C, law.order);
  law.q = q;
  law.D = profile.correction(line.D, q);

  // Student's t also where digits explain the scatter: levels that follow another law may do so by chance.
  const double free = static_cast<double>(n - parameters), t = student(0.95, n - parameters);
  const double known = profile.least(law.order);
  const double bound = smallest + t * t * std::max(smallest / free, known);
  // The farthest p at which the residual stays within the bound; it may exceed it in between.
  const auto boundary = [&](int end, int step) {
    int outer = end;
    while (outer != lowest && !(scan[static_cast<std::size_t>(outer)] <= bound)) outer += step;
    double inside = outer == lowest ? best : place(outer), outside = place(outer - step);
    if (outer == end) {
      if (outer != lowest || scan[static_cast<std::size_t>(outer)] <= bound) return step > 0 ? -infinity : infinity;
      outside = place(end);
    }
    for (int i = 0; i < 40; ++i) {
      const double middle = (inside + outside) / 2.0;
      (residual(middle) <= bound ? inside : outside) = middle;
    }
    return inside;
  };
  const double low = boundary(0, 1), high = boundary(cells, -1);
  law.low = std::isinf(low) ? 0.0 : std::exp(low);
  law.high = std::isinf(high) ? infinity : std::exp(high);
  // At each p the values within the bound are an interval; the profile's is their union.
  const double from = std::max(low, first), to = std::min(high, last);
  constexpr int samples = 24;
  law.value_low = infinity;
  law.value_high = -infinity;
  for (int i = 0; i <= samples + 1; ++i) {
    const Line inside = profile.at(std::exp(i > samples ? best : from + (to - from) * i / samples), q);
    const double width = std::sqrt(std::max(bound - inside.residual, 0.0) * inside.variance);
    law.value_low = std::min(law.value_low, profile.value(inside.value - width));
    law.value_high = std::max(law.value_high, profile.value(inside.value + width));
  }
  if (std::isinf(low)) {  // orders toward 0: a limit as far away as one likes, on the side that the values go to
    (law.C > 0.0 ? law.value_low : law.value_high) = law.C > 0.0 ? -infinity : infinity;
    if (best - first < 1e-3) {
      law.order = 0.0;
      law.value = not_estimated;
    }
  }
  return {law, smallest, bound, smallest <= known * gsl_cdf_chisq_Pinv(0.5, free)};
}

/// Unites the fits with corrections of these exponents, of all that the best does not exclude.
ValueLaw fit_with_any(std::span<const Value> values, std::span<const double> exponents, std::size_t parameters) {
  if (values.size() <= parameters) return {};
  const bool printed = std::all_of(values.begin(), values.end(), [](const Value& v) { return v.digits > 0.0; });
  std::vector<Fitted> fits;
  const auto best = [&] {
    return std::min_element(fits.begin(), fits.end(), [](auto& a, auto& b) { return a.residual < b.residual; });
  };
  for (const Noise noise : {Noise::digits, Noise::errors}) {
    if (noise == Noise::digits && !printed) continue;
    const Profile profile(values, noise);
    fits.clear();
    for (const double q : exponents) fits.push_back(fit(profile, values.size(), q));
    if (best()->explained) break;
  }
  ValueLaw law = best()->law;
  for (const Fitted& other : fits) {
    if (!(other.residual <= best()->bound)) continue;
    law.low = std::min(law.low, other.law.low);
    law.high = std::max(law.high, other.law.high);
    law.value_low = std::min(law.value_low, other.law.value_low);
    law.value_high = std::max(law.value_high, other.law.value_high);
  }
  return law;
}

}  // namespace

ValueLaw fit_value_law(std::span<const Value> values) { return fit_with_any(values, no_correction, 3); }

ValueLaw fit_corrected_value_law(std::span<const Value> values) { return fit_with_any(values, corrections, 4); }

ValueLaw reported_value_law(std::span<const Value> values) {
  return values.size() > 4 ? fit_corrected_value_law(values) : fit_value_law(values);
}

std::vector<Difference> differences_of(std::span<const Value> values) {
  // A double holds a number to half a unit of its last bit, however many digits are printed.
  const auto open = [](const Value& value) {
    return std::max(value.digits, std::abs(value.value) * std::numeric_limits<double>::epsilon() / 2.0);
  };
  std::vector<Difference> all;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const Value &coarse = values[i - 1], &fine = values[i];
    all.push_back({coarse.variable, fine.variable, coarse.value - fine.value, open(coarse) + open(fine)});
  }
  return all;
}

std::optional<double> order_between(const Difference& coarse, const Difference& fine) {
  const double sign = (coarse.difference > 0.0) == (fine.difference > 0.0) ? 1.0 : -1.0;
  const double wanted = std::log(std::abs(coarse.difference / fine.difference));
  const double outer = std::log(coarse.variable / coarse.finer), inner = std::log(fine.variable / fine.finer);
  // The logarithm of (r^p - sign)/(1 - sign s^-p), the ratio of the differences, grows with p.
  const auto excess = [&](double p) {
    if (sign < 0.0) return std::log((1.0 + std::exp(p * outer)) / (1.0 + std::exp(-p * inner))) - wanted;
    if (p == 0.0) return std::log(outer / inner) - wanted;
    return std::log(std::expm1(p * outer) / -std::expm1(-p * inner)) - wanted;
  };
  constexpr double end = 20.0;
  if (!(excess(-end) < 0.0) || !(excess(end) > 0.0)) return std::nullopt;
  std::uintmax_t iterations = 100;
  const auto bracket =
      boost::math::tools::toms748_solve(excess, -end, end, boost::math::tools::eps_tolerance<double>(50), iterations);
  return (bracket.first + bracket.second) / 2.0;
}

Level level_of(const Difference& difference, double p) {
  const double logarithm = std::log(difference.variable / difference.finer);
  const double ratio = std::expm1(p * logarithm);  // (v_1^p - v_2^p)/v_2^p
  // The mean of log v with weight v^(p-1): the derivative of log(v_1^p - v_2^p) with respect to p, less 1/p.
  const double v = difference.variable * std::exp(logarithm / ratio - 1.0 / p);
  const double size = std::abs(difference.difference);
  Level level{v, size * std::pow(v / difference.finer, p) / ratio};
  if (size > 0.0) level.noise = difference.digits / size / std::sqrt(3.0);
  return level;
}

}  // namespace acstudy
