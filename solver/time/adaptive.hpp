#pragma once

/// @file
/// Steps as long as an estimate of their error allows.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

#include "solver/time/steps.hpp"

namespace acstudy {

/// The larger of two sizes; NaN if one is.
inline double larger(double a, double b) { return a > b || std::isnan(a) ? a : b; }

/// The largest |value|; NaN if one is.
inline double largest_of(std::span<const double> values) {
  double largest = 0.0;
  for (const double value : values) largest = larger(largest, std::abs(value));
  return largest;
}

/// An estimated error of a step over what is tolerated: `tolerance` itself where |u| is at most 1, and that part of the
/// largest |u| where it is more.
/// @param error      the largest over all entries
/// @param u_n, u     the largest |u| before and after the step
inline double error_over(double tolerance, double error, double u_n, double u) {
  return error / (tolerance * larger(1.0, larger(u_n, u)));
}

/// Steps to T, each of which stands if its estimated error is tolerated, and is else to be taken back and tried again
/// shorter. Their lengths are those of a PI controller (Hairer & Wanner, section IV.2): they follow the last two
/// errors, so that explicit steps settle where stability limits them. The last two steps are alike if one would be a
/// rest.
class AdaptiveSteps {
 public:
  /// @param first  length of the first step that is tried, > 0
  /// @param order  k, where the estimate of a short step is proportional to dt^k
  AdaptiveSteps(double T, double first, int order) : T_(T), k_(order), wanted_(first) {}

  /// The step to try; none at T.  @throws std::domain_error if it is too short to advance time
  std::optional<TimeStep> next() {
    if (t_ == T_) return std::nullopt;
    const double left = T_ - t_;
    const bool last = wanted_ >= left * (1.0 - 1e-12);
    const double dt = last ? left : std::min(wanted_, 0.5 * left);
    step_ = {t_, last ? T_ : t_ + dt, dt};
    if (step_.end == t_) {
      throw std::domain_error(
          "the time step has become too small to advance time: at no length was its estimated error tolerated");
    }
    return step_;
  }

  /// Judges the step that next() gave; true if it stands.
  /// @param error  what is estimated over what is tolerated; NaN where the step leads nowhere
  bool stands(double error) {
    constexpr double safety = 0.9, least = 0.2, most = 5.0, smallest_error = 1e-4;
    const bool stands = error <= 1.0;
    if (stands) {
      const double e = std::max(error, smallest_error);
      const double factor = safety * std::pow(e, -0.7 / k_) * std::pow(last_error_, 0.4 / k_);
      wanted_ = step_.dt * std::clamp(factor, least, retried_ ? 1.0 : most);
      last_error_ = e;
      t_ = step_.end;
    } else {
      const double factor = std::isfinite(error) ? safety * std::pow(error, -1.0 / k_) : 0.0;
      wanted_ = step_.dt * std::max(factor, least);
      ++rejected_;
    }
    retried_ = !stands;
    return stands;
  }

  std::int64_t rejected() const { return rejected_; }

 private:
  double T_;
  double k_;
  double wanted_;  ///< length of the next step, but for the end
  double t_ = 0.0;
  TimeStep step_ = {};
  double last_error_ = 1.0;
  bool retried_ = false;  ///< the step before was rejected: this one starts where it did, and the next is no longer
  std::int64_t rejected_ = 0;
};

/// Takes steps until T.
///
/// @param take       take(step) advances what the caller has
/// @param error      error() of the step taken, as AdaptiveSteps::stands() is told
/// @param take_back  take_back() undoes a step that does not stand
/// @param goes_on    as in each_step(), after steps that stand
/// @return           the number of steps that stand
template <class Take, class Error, class TakeBack, class GoesOn>
std::int64_t each_adaptive_step(AdaptiveSteps& steps, Take&& take, Error&& error, TakeBack&& take_back,
                                GoesOn&& goes_on) {
  return each_step(
      steps,
      [&](TimeStep& step) {
        take(step);
        while (!steps.stands(error())) {
          take_back();
          step = *steps.next();
          take(step);
        }
      },
      goes_on);
}

}  // namespace acstudy
