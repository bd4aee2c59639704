#pragma once

/// @file
/// Sums of charges over distance, sum_i q_i/(x_j - x_i), over a window of boxes that moves along the particles.

#include <cstddef>

#include "solver/far/box_tables.hpp"
#include "solver/far/exponential.hpp"
#include "solver/vector/lanes.hpp"

namespace acstudy::far {
inline namespace ACSTUDY_ISA {

/// The moments F_m = sum_i q_i exp(-rate_m (X - x_i)) of the charges in the boxes of a window, for the terms of an
/// exponential sum; X is the right edge of its last box.
///
/// A box that enters multiplies all moments by exp(-rate_m), so distances are measured from near by and no digits are
/// lost to a far origin. What leaves is subtracted: the rates are at least 0.1 over the length of the window, so that
/// what round-off leaves behind fades within some ten windows and stays near 1e-15 of the charges.
///
/// @tparam channels  kinds of charge
template <int channels>
class ReciprocalWindow {
 public:
  /// Doubles that a window of at most `boxes` boxes needs.
  static std::ptrdiff_t memory(const BoxExpansion& e, std::ptrdiff_t boxes) { return boxes * channels * e.padded; }

  /// @param memory  at a multiple of 64 bytes
  ReciprocalWindow(const BoxExpansion& e, std::ptrdiff_t boxes, double* memory) : e_(e), boxes_(boxes), ring_(memory) {
    for (double& moment : moments_) moment = 0.0;
  }

  /// Takes in the next box, given by sum_i q_i tau_i^n, [channels][padded_terms].
  ACSTUDY_ALWAYS_INLINE inline void push(const double* powers) {
    double* const own = box(newest_++);
    for (int m = 0; m < e_.padded; m += lane_count) {
      Lanes sum[channels] = {};
#pragma GCC unroll 32
      for (int n = 0; n < expansion_terms; ++n) {
        const Lanes in = load(e_.in[n] + m);
        for (int c = 0; c < channels; ++c) sum[c] += in * powers[c * padded_terms + n];
      }
      const Lanes decay = exponential(-load(e_.rate + m));
      for (int c = 0; c < channels; ++c) {
        store(own + c * e_.padded + m, sum[c]);
        double* const moment = moments_ + c * e_.padded + m;
        store(moment, load(moment) * decay + sum[c]);
      }
    }
  }

  bool empty() const { return oldest_ == newest_; }

  /// Lets those of its boxes go that entered before the one of this number, counted from 0.
  ACSTUDY_ALWAYS_INLINE inline void drop_before(std::ptrdiff_t number) {
    while (oldest_ < number && !empty()) pop();
  }

  /// local[c][n] += coefficients in t of the sums over a box that begins `gap` boxes after the end of the window.
  ACSTUDY_ALWAYS_INLINE inline void add_to(double gap, double* local) const {
    double at_box[channels * ExponentialSum::capacity];
    for (int m = 0; m < e_.padded; m += lane_count) {
      const Lanes decay = exponential(load(e_.rate + m) * -gap);
      for (int c = 0; c < channels; ++c) store(at_box + c * e_.padded + m, decay * load(moments_ + c * e_.padded + m));
    }
    constexpr int vectors = padded_terms / lane_count;
    Lanes sum[channels * vectors] = {};
    for (int m = 0; m < e_.count; ++m) {
#pragma GCC unroll 8
      for (int v = 0; v < vectors; ++v) {
        const Lanes out = load(e_.out[m] + v * lane_count);
        for (int c = 0; c < channels; ++c) sum[c * vectors + v] += out * at_box[c * e_.padded + m];
      }
    }
#pragma GCC unroll 32
    for (int k = 0; k < channels * vectors; ++k) store(local + k * lane_count, load(local + k * lane_count) + sum[k]);
  }

 private:
  ACSTUDY_ALWAYS_INLINE inline void pop() {
    const double* const own = box(oldest_++);
    if (empty()) {
      for (double& moment : moments_) moment = 0.0;
      return;
    }
    const auto behind = static_cast<double>(newest_ - oldest_);
    for (int m = 0; m < e_.padded; m += lane_count) {
      const Lanes decay = exponential(load(e_.rate + m) * -behind);
      for (int c = 0; c < channels; ++c) {
        double* const moment = moments_ + c * e_.padded + m;
        store(moment, load(moment) - decay * load(own + c * e_.padded + m));
      }
    }
  }

  double* box(std::ptrdiff_t number) { return ring_ + number % boxes_ * channels * e_.padded; }

  const BoxExpansion& e_;
  std::ptrdiff_t boxes_, oldest_ = 0, newest_ = 0;
  double* ring_;  ///< the moments of each box by itself
  double moments_[channels * ExponentialSum::capacity];
};

}  // namespace ACSTUDY_ISA
}  // namespace acstudy::far
