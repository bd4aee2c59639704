#pragma once

/// @file
/// Velocities at the midpoints between several particles and their neighbors, without a function call per pair.

#include "solver/vector/lanes.hpp"
#include "solver/vector/sweeps.hpp"

namespace acstudy {
inline namespace ACSTUDY_ISA {

// A representation M of the velocities is made for a vector of particles from j on and asked at the neighbors from i
// on, which stand at x_i:
//
//   M(sweep, j)                        once
//   c_hat(i, x_i), b(i, x_i)           at the midpoints

/// Velocities of few modes, each a product of what belongs to either particle; see SymmetricSweep. The first `b_modes`
/// modes may be in b.
template <int modes, int b_modes>
class TrigonometricMidpoints {
 public:
  TrigonometricMidpoints(const SymmetricSweep& sweep, std::ptrdiff_t j) : sweep_(sweep) {
    for (int n = 0; n < modes; ++n) {
      const Lanes C = load(sweep.half_cosine[n] + j), S = load(sweep.half_sine[n] + j);
      c_hat_C_[n] = sweep.c_hat.cosine[n] * C + sweep.c_hat.sine[n] * S;
      c_hat_S_[n] = sweep.c_hat.sine[n] * C - sweep.c_hat.cosine[n] * S;
      if (n >= b_modes) continue;
      b_C_[n] = sweep.b.cosine[n] * C + sweep.b.sine[n] * S;
      b_S_[n] = sweep.b.sine[n] * C - sweep.b.cosine[n] * S;
    }
  }
  Lanes c_hat(std::ptrdiff_t i, Lanes) const { return at<modes>(i, sweep_.c_hat.constant, c_hat_C_, c_hat_S_); }
  Lanes b(std::ptrdiff_t i, Lanes) const { return at<b_modes>(i, sweep_.b.constant, b_C_, b_S_); }

 private:
  template <int count>
  Lanes at(std::ptrdiff_t i, double constant, const Lanes* by_C, const Lanes* by_S) const {
    Lanes value = spread(constant);
    for (int n = 0; n < count; ++n) {
      value += by_C[n] * load(sweep_.half_cosine[n] + i);
      value += by_S[n] * load(sweep_.half_sine[n] + i);
    }
    return value;
  }

  const SymmetricSweep& sweep_;
  Lanes c_hat_C_[modes + 1], c_hat_S_[modes + 1], b_C_[b_modes + 1], b_S_[b_modes + 1];
};

/// Any smooth velocities, by one polynomial for all midpoints of a vector of particles; see SweepPanels.
class PolynomialMidpoints {
 public:
  PolynomialMidpoints(const SymmetricSweep& sweep, std::ptrdiff_t j) : panels_(sweep.panels), x_(load(sweep.x + j)) {
    const double center = 0.5 * (sweep.x[j] + sweep.x[j + lane_count - 1]);
    const double number = __builtin_floor(center / panels_.spacing + 0.5);
    const auto panel = static_cast<std::ptrdiff_t>(number);
    const std::ptrdiff_t wrapped = (panel % panels_.count + panels_.count) % panels_.count;
    c_hat_ = panels_.c_hat + wrapped * panels_.terms;
    b_ = panels_.b + wrapped * panels_.terms;
    half_scale_ = 0.5 / panels_.radius;
    t_ = (x_ - 2.0 * number * panels_.spacing) * half_scale_;
  }
  Lanes c_hat(std::ptrdiff_t, Lanes x) const { return at(c_hat_, x); }
  Lanes b(std::ptrdiff_t, Lanes x) const { return at(b_, x); }

 private:
  Lanes at(const double* coefficient, Lanes x) const {
    const Lanes t = x * half_scale_ + t_;
    Lanes value = {};
    for (int n = panels_.terms; n > 0; n -= 4) {
      value = value * t + coefficient[n - 1];
      value = value * t + coefficient[n - 2];
      value = value * t + coefficient[n - 3];
      value = value * t + coefficient[n - 4];
    }
    return value;
  }

  const SweepPanels& panels_;
  Lanes x_, t_;
  const double *c_hat_, *b_;
  double half_scale_;
};

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
