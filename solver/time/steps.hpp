#pragma once

/// @file
/// The steps of a run: equal ones, or as long as a bound allows.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>

namespace acstudy {

/// Equal steps: the fewest with dt <= bound (T an exact multiple of the bound up to round-off counts as such).
inline std::int64_t steps_for(double T, double bound) {
  return static_cast<std::int64_t>(std::ceil(T / bound * (1.0 - 1e-12)));
}

/// From t^n to t^{n+1}. Steps of one length have it to the bit, though the difference of their times is rounded.
struct TimeStep {
  double begin, end, dt;
  /// The last stage of a step and the first of the next see the same time, to the bit.
  double at(double fraction) const { return fraction == 1.0 ? end : begin + fraction * dt; }
};

/// T in `count` equal steps, t^n = n T / count.  T = 0 takes none.
class EqualSteps {
 public:
  EqualSteps(double T, std::int64_t count)
      : T_(T), dt_(count == 0 ? 0.0 : T / static_cast<double>(count)), count_(count) {}
  std::optional<TimeStep> next() {
    if (n_ == count_) return std::nullopt;
    const double begin = at(n_);
    return TimeStep{begin, at(++n_), dt_};
  }

 private:
  double at(std::int64_t n) const { return n == count_ ? T_ : static_cast<double>(n) * dt_; }
  double T_, dt_;
  std::int64_t count_, n_ = 0;
};

/// Steps to T that a bound limits anew each time: the rest of T in the fewest equal steps within the bound, of which
/// one is taken. So none is much smaller than the bound, the last one ends at T, and while the bound stays the steps
/// are equal.
template <class Bound>
class BoundedSteps {
 public:
  /// @param bound  bound(t) > 0: the largest step from t on
  BoundedSteps(double T, Bound bound) : T_(T), bound_(std::move(bound)) {}
  std::optional<TimeStep> next() {
    if (t_ == T_) return std::nullopt;
    const double begin = t_;
    if (const double limit = bound_(t_); limit != limit_) {
      limit_ = limit;
      left_ = std::max(1.0, std::ceil((T_ - t_) / limit * (1.0 - 1e-12)));
      dt_ = (T_ - t_) / left_;
    }
    left_ -= 1.0;
    t_ = left_ == 0.0 ? T_ : t_ + dt_;
    if (t_ == begin) throw std::domain_error("the time step has become too small to advance time");
    return TimeStep{begin, t_, dt_};
  }

 private:
  double T_;
  Bound bound_;
  double t_ = 0.0, limit_ = 0.0;
  double dt_ = 0.0, left_ = 0.0;  ///< the equal steps to T at this limit
};

/// Takes step after step.
///
/// @param steps    `next()` gives a TimeStep until there is none
/// @param take     take(step) advances what the caller has; it may make the step another one
/// @param goes_on  called with n and the step after each step n = 1, 2, ...; false ends the run early
/// @return         the number of steps done
template <class Steps, class Take, class GoesOn>
std::int64_t each_step(Steps&& steps, Take&& take, GoesOn&& goes_on) {
  std::int64_t n = 0;
  while (std::optional<TimeStep> step = steps.next()) {
    take(*step);
    ++n;
    if (!goes_on(n, *step)) break;
  }
  return n;
}

}  // namespace acstudy
