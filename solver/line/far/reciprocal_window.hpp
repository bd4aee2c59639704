#pragma once

/// @file
/// Sums of charges over distance, sum_i q_i/(x_j - x_i), over a window of boxes that moves along the particles.

#include <cstddef>

#include "solver/line/far/box_tables.hpp"
#include "solver/line/far/exponential.hpp"
#include "solver/line/vector/lanes.hpp"

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
template <int channels, int terms>
class ReciprocalWindow {
 public:
  using Expansion = BoxExpansion<terms>;
  static constexpr int powers_size = channels * padded(terms);

  /// Doubles that a window of at most `boxes` boxes needs.
  static std::ptrdiff_t memory(const Expansion& e, std::ptrdiff_t boxes) { return boxes * channels * e.padded_count; }

  /// @param memory  at a multiple of 64 bytes
  ReciprocalWindow(const Expansion& e, std::ptrdiff_t boxes, double* memory)
      : e_(e), boxes_(boxes), ring_(memory), since_(e), until_(e) {
    for (double& moment : moments_) moment = 0.0;
  }

  /// Takes in the next box, given by sum_i q_i tau_i^n, [channels][padded(terms)].
  ACSTUDY_NEVER_INLINE void push(const double* powers) {
    double* const own = box(newest_++);
    for (int m = 0; m < e_.padded_count; m += lane_count) {
      Lanes sum[channels] = {};
#pragma GCC unroll 32
      for (int n = 0; n < terms; ++n) {
        const Lanes in = load(e_.in[n] + m);
        for (int c = 0; c < channels; ++c) sum[c] += in * powers[c * padded(terms) + n];
      }
      const Lanes decay = load(e_.decay + m);
      for (int c = 0; c < channels; ++c) {
        store(own + c * e_.padded_count + m, sum[c]);
        double* const moment = moments_ + c * e_.padded_count + m;
        store(moment, load(moment) * decay + sum[c]);
      }
    }
  }

  bool empty() const { return oldest_ == newest_; }

  /// Lets those of its boxes go that entered before the one of this number, counted from 0.
  ACSTUDY_ALWAYS_INLINE inline void drop_before(std::ptrdiff_t number) {
    while (oldest_ < number && !empty()) pop();
  }

  /// local[c * stride + n] += coefficients in t of the sums over a box that begins `gap` boxes after the end of the
  /// window.
  ACSTUDY_NEVER_INLINE void add_to(double gap, double* local, int stride) {
    const double* const decay = until_.over(gap);
    double at_box[channels * ExponentialSum::capacity];
    for (int m = 0; m < e_.padded_count; m += lane_count) {
      for (int c = 0; c < channels; ++c) {
        const int k = c * e_.padded_count + m;
        store(at_box + k, load(decay + m) * load(moments_ + k));
      }
    }
    constexpr int vectors = padded(terms) / lane_count;
    Lanes sum[channels * vectors] = {};
    for (int m = 0; m < e_.count; ++m) {
#pragma GCC unroll 16
      for (int v = 0; v < vectors; ++v) {
        const Lanes out = load(e_.out[m] + v * lane_count);
        for (int c = 0; c < channels; ++c) sum[c * vectors + v] += out * at_box[c * e_.padded_count + m];
      }
    }
    for (int c = 0; c < channels; ++c) {
#pragma GCC unroll 16
      for (int v = 0; v < vectors; ++v) {
        double* const to = local + c * stride + v * lane_count;
        store(to, load(to) + sum[c * vectors + v]);
      }
    }
  }

 private:
  /// exp(-rate_m distance), kept for the next time, when the distance is the same as a rule.
  class Decay {
   public:
    explicit Decay(const Expansion& e) : e_(e) {}
    ACSTUDY_NEVER_INLINE const double* over(double distance) {
      if (distance != distance_) {
        distance_ = distance;
        for (int m = 0; m < e_.padded_count; m += lane_count) {
          store(decay_ + m, exponential(load(e_.rate + m) * -distance));
        }
      }
      return decay_;
    }

   private:
    const Expansion& e_;
    double distance_ = -1.0;
    double decay_[ExponentialSum::capacity];
  };

  ACSTUDY_NEVER_INLINE void pop() {
    const double* const own = box(oldest_++);
    if (empty()) {
      for (double& moment : moments_) moment = 0.0;
      return;
    }
    const double* const decay = since_.over(static_cast<double>(newest_ - oldest_));
    for (int m = 0; m < e_.padded_count; m += lane_count) {
      for (int c = 0; c < channels; ++c) {
        const int k = c * e_.padded_count + m;
        store(moments_ + k, load(moments_ + k) - load(decay + m) * load(own + k));
      }
    }
  }
  double* box(std::ptrdiff_t number) { return ring_ + number % boxes_ * channels * e_.padded_count; }

  const Expansion& e_;
  std::ptrdiff_t boxes_, oldest_ = 0, newest_ = 0;
  double* ring_;  ///< the moments of each box by itself
  double moments_[channels * ExponentialSum::capacity];
  Decay since_, until_;  ///< since the oldest box, until where the window is seen from
};

}  // namespace ACSTUDY_ISA
}  // namespace acstudy::far
