#pragma once

/// @file
/// Watches a run: is it within its bounds, and does it still make sense?

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "solver/time/steps.hpp"
#include "studies/running/run_case.hpp"

namespace acstudy {

/// Takes a step into account.
inline void count_step(CaseResult& result, std::int64_t n, TimeStep step) {
  result.dt = std::max(result.dt, step.dt);
  result.dt_smallest = n == 1 ? step.dt : std::min(result.dt_smallest, step.dt);
  result.steps = n;
}

/// True once a run has taken longer than the limit of its case; its result then says so.
/// @param t  the time that it has come to
bool gave_out(CaseResult& result, const Case& c, double seconds, double t);

/// Compares explicit steps with the bound of their lemma at the particles of each stage.
class BoundWatch {
 public:
  /// A stage is evaluated at particles whose lemma allows steps up to `bound`; the smallest gap begins at `place`.
  void stage(double bound, double place) {
    if (bound < bound_) {
      bound_ = bound;
      place_ = place;
    }
  }
  /// A step has been done.
  void step(std::int64_t n, TimeStep step);
  /// A step has been taken back: its stages count for nothing.
  void take_back() { bound_ = std::numeric_limits<double>::infinity(); }
  const StepsAgainstBound& result() const { return result_; }

 private:
  double bound_ = std::numeric_limits<double>::infinity(), place_ = 0.0;
  StepsAgainstBound result_;
};

/// Gives up a run whose values are not finite, or a million times larger than those of the exact solution.
///
/// A stable run is as large as the exact solution and its error. That far beyond it nothing but exponential growth
/// leads, and nothing leads back.
class GrowthWatch {
 public:
  static constexpr double most = 1e6;

  /// @param u  at the start
  explicit GrowthWatch(std::span<const double> u);
  /// For states that the caller keeps.  @param largest  |u| at the start
  explicit GrowthWatch(double largest) : exact_(largest) {}

  /// Looks at the state after a step; false if the run must end.
  /// @param exact_size  exact_size() is the largest |u| of the exact solution at this time; called on suspicion only
  template <class ExactSize>
  bool makes_sense(std::int64_t n, double t, std::span<double> u, ExactSize&& exact_size);

  /// The same for a state of which the largest |u| is known, NaN or infinite if one is not finite. It is not kept:
  /// where the run must end, the last finite state is the caller's to put back.
  template <class ExactSize>
  bool makes_sense(std::int64_t n, double t, std::span<const double> u, double largest, ExactSize&& exact_size);

  /// Puts the last finite state back.
  void restore(std::span<double> u) const { std::copy(last_u_.begin(), last_u_.end(), u.begin()); }

  /// Why the run ended; empty if it need not. `last` has step, time and particle then.
  const std::string& blow_up() const { return blow_up_; }
  const LastState& last() const { return last_; }

 private:
  /// Largest |u|; NaN or infinite if one is.
  static double size(std::span<const double> u);
  void give_up(std::int64_t n, double t, std::span<const double> u, std::int64_t last_step, double last_t,
               const std::string& how);

  double exact_;                ///< largest |u| of the exact solution so far
  std::vector<double> last_u_;  ///< the last finite state, and its time
  double last_t_ = 0.0;
  std::string blow_up_;
  LastState last_;
};

template <class ExactSize>
bool GrowthWatch::makes_sense(std::int64_t n, double t, std::span<const double> u, double largest,
                              ExactSize&& exact_size) {
  if (!std::isfinite(largest)) {
    give_up(n, t, u, n - 1, last_t_, "is no longer finite");
    return false;
  }
  if (largest > most * exact_) exact_ = std::max(exact_, exact_size());
  if (largest > most * exact_) {
    give_up(n, t, u, n, t, fmt::format("has grown to {:.3g}, the exact one to {:.3g},", largest, exact_));
    return false;
  }
  last_t_ = t;
  return true;
}

template <class ExactSize>
bool GrowthWatch::makes_sense(std::int64_t n, double t, std::span<double> u, ExactSize&& exact_size) {
  const double now = size(u);
  const bool makes_sense = this->makes_sense(n, t, u, now, exact_size);
  if (!std::isfinite(now)) {
    restore(u);
  } else {
    std::copy(u.begin(), u.end(), last_u_.begin());
  }
  return makes_sense;
}

}  // namespace acstudy
