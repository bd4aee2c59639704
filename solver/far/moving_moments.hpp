#pragma once

/// @file
/// Sums of charges over distance, sum_i q_i / (x_j - x_i), whose window moves along the particles, O(1) per particle.

#include <cstddef>

#include "solver/far/exponential.hpp"
#include "solver/far/exponential_sum.hpp"
#include "solver/vector/lanes.hpp"

namespace acstudy::far {
inline namespace ACSTUDY_ISA {

/// Charges enter and leave in panels of this many particles.
inline constexpr int panel_size = 8;

/// The moments F_m = sum_i q_i exp(-r_m (X - x_i)) of the charges in a window, for the terms of an exponential sum.
///
/// Charges enter in panels at the front and leave in the same panels at the back. A front X that moves on multiplies
/// all moments by exp(-r_m (X' - X)), so distances are measured from near by and no digits are lost to a far origin.
/// What leaves is subtracted: the rates are at least 0.1 over the length of the window, so that what round-off leaves
/// behind fades within some ten windows and stays near 1e-15 of the charges.
///
/// @tparam channels  kinds of charge
template <int channels>
class MovingMoments {
 public:
  /// Doubles that a window of at most `panels` panels needs, at a multiple of 64 bytes.
  static std::ptrdiff_t memory(std::ptrdiff_t panels, const ExponentialSum& sum) {
    return panels * stride(sum.padded) + 2 * channels * sum.padded;
  }

  /// @param nearest  least distance of a charge at which it is evaluated; the sum is scaled to it
  MovingMoments(const ExponentialSum& sum, double nearest, std::ptrdiff_t panels, double* memory)
      : count_(sum.count), padded_(sum.padded), panels_(panels) {
    for (int m = 0; m < padded_; ++m) {
      rate_[m] = sum.rate[m] / nearest;
      weight_[m] = sum.weight[m] / nearest;
    }
    moments_ = memory;
    at_first_ = moments_ + channels * padded_;
    ring_ = at_first_ + channels * padded_;
    clear();
  }

  bool empty() const { return oldest_ == newest_; }

  /// Takes in the charges q[c * panel_size + i] at the increasing positions x[i]; the last of them is the front.
  ACSTUDY_ALWAYS_INLINE inline void push(const double* x, const double* q) {
    const double front = x[panel_size - 1], passed = empty() ? 0.0 : front_ - front;
    double* const panel = ring_ + newest_++ % panels_ * stride(padded_);
    front_ = panel[0] = front;
    for (int m = 0; m < padded_; m += lane_count) {
      const Lanes rate = load(rate_ + m);
      Lanes sum[channels] = {};
#pragma GCC unroll 8
      for (int i = 0; i < panel_size; ++i) {
        const Lanes decay = exponential(rate * (x[i] - front));
        for (int c = 0; c < channels; ++c) sum[c] += decay * q[c * panel_size + i];
      }
      const Lanes decay = exponential(rate * passed);
      for (int c = 0; c < channels; ++c) {
        store(moments_of(panel, c) + m, sum[c]);
        double* const moment = moments_ + c * padded_ + m;
        store(moment, load(moment) * decay + sum[c]);
      }
    }
  }

  /// Lets the oldest panel go.  @pre !empty()
  ACSTUDY_ALWAYS_INLINE inline void pop() {
    double* const panel = ring_ + oldest_++ % panels_ * stride(padded_);
    if (empty()) {
      clear();
      return;
    }
    for (int m = 0; m < padded_; m += lane_count) {
      const Lanes decay = exponential(load(rate_ + m) * (panel[0] - front_));
      for (int c = 0; c < channels; ++c) {
        double* const moment = moments_ + c * padded_ + m;
        store(moment, load(moment) - decay * load(moments_of(panel, c) + m));
      }
    }
  }

  /// sum[c] += sum_i q_i / (x - x_i) at positions x >= first.
  ACSTUDY_ALWAYS_INLINE inline void add(double first, Lanes x, Lanes* sum) {
    for (int m = 0; m < padded_; m += lane_count) {
      const Lanes decay = load(weight_ + m) * exponential(load(rate_ + m) * (front_ - first));
      for (int c = 0; c < channels; ++c) {
        store(at_first_ + c * padded_ + m, decay * load(moments_ + c * padded_ + m));
      }
    }
    const Lanes distance = first - x;
#pragma GCC unroll 2
    for (int m = 0; m < count_; ++m) {
      const Lanes decay = exponential(distance * rate_[m]);
      for (int c = 0; c < channels; ++c) sum[c] += decay * at_first_[c * padded_ + m];
    }
  }

 private:
  /// A panel keeps its front and its own moments there.
  static std::ptrdiff_t stride(int padded) { return panel_size + channels * padded; }
  double* moments_of(double* panel, int c) const { return panel + panel_size + c * padded_; }

  void clear() {
    for (int m = 0; m < channels * padded_; ++m) moments_[m] = 0.0;
  }

  int count_, padded_;
  std::ptrdiff_t panels_, oldest_ = 0, newest_ = 0;
  double front_ = 0.0;
  double* moments_;   ///< F_m, channel after channel
  double* at_first_;  ///< the same at the first position of a block, times the weights
  double* ring_;      ///< the panels
  double rate_[ExponentialSum::capacity];
  double weight_[ExponentialSum::capacity];
};

}  // namespace ACSTUDY_ISA
}  // namespace acstudy::far
