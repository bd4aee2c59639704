#pragma once

/// @file
/// Velocities at the midpoints between several particles and their neighbors, without a function call per pair.

#include "solver/line/vector/lanes.hpp"
#include "solver/line/vector/sweeps.hpp"

namespace acstudy {
inline namespace ACSTUDY_ISA {

/// Velocities at midpoints.
struct MidpointVelocities {
  Lanes c_hat, c;
};

// A representation M of the velocities is made for a vector of particles from j on and asked at the neighbors from i
// on, which stand at x_i:
//
//   M(sweep, j)     once
//   at(i, x_i)      at the midpoints

/// A field of few modes at midpoints, each mode a product of what belongs to either particle; see SymmetricSweep.
template <int modes>
class TrigonometricMidpoints {
 public:
  TrigonometricMidpoints(const SymmetricSweep& sweep, const SweepField& field, std::ptrdiff_t j)
      : constant_(spread(field.constant)) {
    for (int n = 0; n < modes; ++n) {
      half_cosine_[n] = sweep.half_cosine[field.mode[n]];
      half_sine_[n] = sweep.half_sine[field.mode[n]];
      const Lanes C = load(half_cosine_[n] + j), S = load(half_sine_[n] + j);
      by_C_[n] = field.cosine[n] * C + field.sine[n] * S;
      by_S_[n] = field.sine[n] * C - field.cosine[n] * S;
    }
  }
  ACSTUDY_ALWAYS_INLINE inline Lanes at(std::ptrdiff_t i) const {
    Lanes value = constant_;
    for (int n = 0; n < modes; ++n) {
      value += by_C_[n] * load(half_cosine_[n] + i);
      value += by_S_[n] * load(half_sine_[n] + i);
    }
    return value;
  }

 private:
  const double *half_cosine_[modes], *half_sine_[modes];
  Lanes constant_, by_C_[modes], by_S_[modes];
};

/// Velocities c and b of few modes each.
template <int c_modes, int b_modes>
class ModalMidpoints {
 public:
  ModalMidpoints(const SymmetricSweep& sweep, std::ptrdiff_t j) : c_(sweep, sweep.c, j), b_(sweep, sweep.b, j) {}
  ACSTUDY_ALWAYS_INLINE inline MidpointVelocities at(std::ptrdiff_t i, Lanes) const {
    const Lanes c = c_.at(i);
    return {c - b_.at(i), c};
  }

 private:
  TrigonometricMidpoints<c_modes> c_;
  TrigonometricMidpoints<b_modes> b_;
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
  ACSTUDY_ALWAYS_INLINE inline MidpointVelocities at(std::ptrdiff_t, Lanes x) const {
    const Lanes c_hat = value(c_hat_, x);
    return {c_hat, c_hat + value(b_, x)};
  }

 private:
  ACSTUDY_ALWAYS_INLINE inline Lanes value(const double* coefficient, Lanes x) const {
    const Lanes t = x * half_scale_ + t_;
    Lanes sum = {};
    for (int n = panels_.terms; n > 0; n -= 4) {
      sum = sum * t + coefficient[n - 1];
      sum = sum * t + coefficient[n - 2];
      sum = sum * t + coefficient[n - 3];
      sum = sum * t + coefficient[n - 4];
    }
    return sum;
  }

  const SweepPanels& panels_;
  Lanes x_, t_;
  const double *c_hat_, *b_;
  double half_scale_;
};

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
