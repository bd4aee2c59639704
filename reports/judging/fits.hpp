#pragma once

/// @file
/// Models of an error under refinement, fitted to its levels: power law, power law with correction, with floor.
///
/// Every fit is weighted least squares in the logarithms of variable and error, or in relative errors, at the actual
/// variable of each level; so any refinement ratio is right. Preconditions throughout: variables, errors and weights
/// are finite and positive, and variables fall strictly. With too few levels for a model all its members are NaN.

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace acstudy {

/// One level of a refinement: the variable of theory (h, or max(h, delta)) and the error there.
struct Level {
  double variable;
  double error;
  double weight = 1.0;  ///< of the squared relative error; proportional to one over its variance
  /// Least standard deviation of the relative error that is known beforehand, as that of printed digits; 0: not known.
  double noise = 0.0;
};

using LevelView = std::span<const Level>;

inline constexpr double not_estimated = std::numeric_limits<double>::quiet_NaN();

/// An order of convergence with its 95 % interval (Student t).
struct Estimate {
  double order = not_estimated, low = not_estimated, high = not_estimated;

  double half_width() const { return (high - low) / 2.0; }
  bool contains(double value) const { return low <= value && value <= high; }
};

/// error = C v^p, from three levels on. `residual`: weighted sum of squares, here and below.
struct PowerLaw : Estimate {
  double C = not_estimated, residual = not_estimated;

  double at(double v) const { return C * std::pow(v, order); }
};

/// error = C v^p (1 + D v^q), from four levels on, or five where q is fitted too.
struct CorrectedLaw : Estimate {
  double C = not_estimated, D = not_estimated, q = not_estimated, residual = not_estimated;

  double at(double v) const { return C * std::pow(v, order) * (1.0 + D * std::pow(v, q)); }
  double order_between(double coarse, double fine) const {
    return std::log(at(coarse) / at(fine)) / std::log(coarse / fine);
  }
};

/// error = C v^p + F, from four levels on. F <= 0: the levels show no floor.
struct FlooredLaw : Estimate {
  double C = not_estimated, F = not_estimated, residual = not_estimated;
};

/// Weighted least-squares line; variance of the slope for errors of unit variance over weight.
struct FittedLine {
  double intercept = 0.0, slope = 0.0, slope_variance = 0.0, residual = 0.0;
};

/// Lines through many values at the same places x: what does not depend on the values is computed once. Places of
/// weight 0 are left out.
class WeightedLines {
 public:
  WeightedLines() = default;
  /// @param weight  of each place
  WeightedLines(std::span<const double> x, std::span<const double> weight);

  FittedLine through(std::span<const double> y) const;

 private:
  std::vector<double> weight_, share_, dx_;
  double total_ = 0.0, mean_ = 0.0, square_ = 0.0;
};

PowerLaw fit_power_law(LevelView levels);

/// The exponent q is the best of 1/2, 1, 2, 3, 4 and 6.
///
/// The interval unites those of the exponents up to 3 that fit about as well, each that of its profile: all orders at
/// which the sum of squares, minimized over C and D, stays below (1 + t^2/(levels - 3)) times its minimum. It is not
/// symmetric. The parts are narrower than the whole is to be, the more so where the orders do not drift, since then all
/// exponents say the same; that the whole then has its probability is measured (coverage.hpp).
/// @param miss  the probability that the interval misses the order
CorrectedLaw fit_corrected_law(LevelView levels, double miss = 0.05);

/// The same without the interval, which takes most of the time; the latter with q given.
CorrectedLaw fit_corrected_law_only(LevelView levels);
CorrectedLaw fit_corrected_law_only(LevelView levels, double q);

/// The order is given and C, D and q, from 0.05 to 6, are fitted: the correction that this order would need. No
/// interval. At the finest level the order may still be hidden behind the second term, up to 0.1 short of p + q.
CorrectedLaw fit_correction_of(LevelView levels, double order);

/// The same where q is one of 1/2, 1, ..., 6, as expansions of errors have it.
CorrectedLaw fit_usual_correction_of(LevelView levels, double order);

/// The interval is that of the profile over C and F.
FlooredLaw fit_floored_law(LevelView levels);

/// The t that a Student variable stays within, on both sides, with this probability.
double student(double probability, std::size_t degrees_of_freedom);

/// F test: true if one parameter more, or one level less, lowers the sum of squares from `before` to `after` by more
/// than chance does with probability `level`. The degrees of freedom are those of `after`.
bool significant(double before, double after, std::size_t degrees_of_freedom, double level);

/// The same for laws fitted to these levels, the better one with so many parameters; noise that is known counts.
bool explains_more(LevelView levels, double before, double after, std::size_t parameters, double level);

}  // namespace acstudy
