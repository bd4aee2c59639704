#pragma once

/// @file
/// Model I with slopes: an upwind kernel of second order, beyond the paper. Stationary, moving with local or nonlocal
/// divergence; with a limiter for data that is not smooth.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "solver/kernels.hpp"
#include "solver/line/least_squares.hpp"
#include "solver/line/particles.hpp"
#include "solver/rate_matrix.hpp"
#include "solver/velocity.hpp"

namespace acstudy {

/// W_1 .. W_L of one particle that looks left (s = +1) or right (s = -1), nearest neighbor first, and its distances
/// d_1 .. d_L; see SlopesPlaced.
///
/// @param x  at the particle; its neighbors are x[-s k]
template <int s, Kernel K>
void midway_weights(const K& kernel, const double* x, double delta, std::span<double> W, std::span<double> d) {
  const std::ptrdiff_t L = std::ssize(W);
  for (std::ptrdiff_t k = 1; k <= L; ++k) d[k - 1] = s * (x[0] - x[-s * k]);
  CellWalk cells(delta);
  for (std::ptrdiff_t k = 1; k < L; ++k) {
    const double bound = 0.5 * (d[k - 1] + d[k]);
    const double width = k == 1 ? bound : 0.5 * s * (x[-s * (k - 1)] - x[-s * (k + 1)]);
    W[k - 1] = kernel.first_moment(cells.to(bound, width)) / d[k - 1];
  }
  W[L - 1] = kernel.first_moment(cells.to_horizon()) / d[L - 1];
}

/// What both forms of the scheme have placed: velocities, weights and slopes. With g = c_hat u and the notation of
/// ModelI, but cells bounded midway between neighbors,
///
///     r_0 = 0,  r_k = (d_k + d_{k+1})/2,  r_L = max(delta, d_L)
///     W_k = m(r_{k-1}, r_k)/d_k,     sum_k d_k W_k = 1, W_k >= 0
///     (L u)_j = s sum_k W_k [ (g_j + s d_k s_j/2) - (g_i + s d_k s_i/2) ]
///     rate_j  = - b'_j u_j - (L u)_j
///
/// where s_j is the slope of g at j, see LeastSquaresSlopes, and b'_j is exact or the slope of b. Each difference is
/// one between values carried half a distance downstream: d_k g'(x_j) but for the third derivative. Exact where g is
/// a quadratic.
///
/// Of second order in max(h, delta) and stable with ssprk3 up to dt max|c_hat| / h_min = 1, as far as was measured;
/// nothing of that is proven.
template <Kernel K, class Divergence>
class SlopesPlaced {
 public:
  explicit SlopesPlaced(K kernel) : kernel_(kernel) {}

  /// Computes velocities, weights and slopes for the particles where they are now.
  template <AdvectionVelocity V>
  void place(const Particles& particles, const V& velocity) {
    const auto n = std::ssize(particles.x);
    widest_ = particles.windows.widest;
    slopes_.place(particles);
    set_velocities(particles, velocity);

    offset_.assign(1, 0);
    for (std::ptrdiff_t j = 0; j < n; ++j) {
      offset_.push_back(offset_[j] + (looks_left(j) ? particles.windows.left[j] : particles.windows.right[j]));
    }
    weights_.resize(offset_[n]);
    distances_.resize(offset_[n]);
    for (std::ptrdiff_t j = 0; j < n; ++j) {
      const double* const x = particles.x.at(j);
      const auto part = [&](std::vector<double>& all) {
        return std::span<double>(all.data() + offset_[j], all.data() + offset_[j + 1]);
      };
      looks_left(j) ? midway_weights<+1>(kernel_, x, particles.delta, part(weights_), part(distances_))
                    : midway_weights<-1>(kernel_, x, particles.delta, part(weights_), part(distances_));
    }
    ++work_.weight_builds;
  }

  /// W_1 .. W_L of particle j, nearest first.
  std::span<const double> weights(std::ptrdiff_t j) const {
    return {weights_.data() + offset_[j], weights_.data() + offset_[j + 1]};
  }
  /// True if particle j looks to its left.
  bool looks_left(std::ptrdiff_t j) const { return c_hat_[j] > 0.0; }
  /// How far from j, in particles, those are that its rate depends on: neighbors of neighbors.
  std::ptrdiff_t reach() const { return widest_ + slopes_.reach(); }

  const WorkCounts& work() const { return work_; }

 protected:
  /// du_j of all j, where `difference(p, a, b)` is that of pair p: of p = g_j - g_i and the carried a = s d_k s_j/2,
  /// b = s d_k s_i/2.
  template <class Difference>
  void rate_by(const PeriodicArray& u, std::span<double> du, Difference difference) {
    const std::ptrdiff_t n = std::ssize(u);
    for (std::ptrdiff_t j = 0; j < n; ++j) g_[j] = c_hat_[j] * u[j];
    g_.wrap(slopes_.reach());
    for (std::ptrdiff_t j = 0; j < n; ++j) slope_[j] = slopes_(j, g_);
    slope_.wrap(widest_);
    for (std::ptrdiff_t j = 0; j < n; ++j) {
      du[j] = -(looks_left(j) ? upwind_sum<+1>(j, difference) : upwind_sum<-1>(j, difference));
      if constexpr (!standing) du[j] -= b_prime_[j] * u[j];
    }
    work_.pairs += std::ssize(weights_) + slopes_.pairs();
  }

  static constexpr bool standing = std::is_same_v<Divergence, NoDivergence>;
  static constexpr bool local = std::is_same_v<Divergence, LocalDivergence>;

  K kernel_;
  LeastSquaresSlopes slopes_;
  PeriodicArray c_hat_;
  std::vector<double> b_prime_;  ///< exact, or the slope of b; empty where particles stand still
  std::vector<std::ptrdiff_t> offset_;
  std::vector<double> weights_, distances_;

 private:
  template <AdvectionVelocity V>
  void set_velocities(const Particles& particles, const V& velocity) {
    const auto x = particles.x.values();
    for (PeriodicArray* const field : {&c_hat_, &g_, &slope_}) {
      if (field->size() != x.size()) *field = PeriodicArray(x.size());
    }
    const auto c_hat = c_hat_.values();
    velocity.c(x, c_hat);
    work_.velocity_evaluations += std::ssize(x);
    if constexpr (!standing) {
      PeriodicArray b(x.size());
      velocity.b(x, b.values());
      b_prime_.resize(x.size());
      if constexpr (local) {
        velocity.b_prime(x, b_prime_);
      } else {
        b.wrap(slopes_.reach());
        for (std::ptrdiff_t j = 0; j < std::ssize(x); ++j) b_prime_[j] = slopes_(j, b);
      }
      for (std::ptrdiff_t j = 0; j < std::ssize(x); ++j) c_hat[j] -= b[j];
      work_.velocity_evaluations += (local ? 2 : 1) * std::ssize(x);
    }
  }

  template <int s, class Difference>
  double upwind_sum(std::ptrdiff_t j, Difference difference) const {
    const std::ptrdiff_t L = offset_[j + 1] - offset_[j];
    const double* const W = weights_.data() + offset_[j];
    const double* const d = distances_.data() + offset_[j];
    const double* const g = g_.at(j);
    const double* const slope = slope_.at(j);
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (std::ptrdiff_t k = 1; k <= L; ++k) {
      const double half = 0.5 * s * d[k - 1];
      sum += W[k - 1] * difference(g[0] - g[-s * k], half * slope[0], half * slope[-s * k]);
    }
    return s * sum;
  }

  PeriodicArray g_, slope_;
  int widest_ = 0;
  WorkCounts work_;
};

/// The scheme itself; see SlopesPlaced.
template <Kernel K, class Divergence>
class Slopes : public SlopesPlaced<K, Divergence> {
 public:
  using SlopesPlaced<K, Divergence>::SlopesPlaced;

  /// du_j = rate_j(u), j = 0 .. N-1.  @pre place() was called
  void rate(PeriodicArray& u, std::span<double> du) {
    this->rate_by(u, du, [](double p, double a, double b) { return p + (a - b); });
  }

  /// The matrix of the rates.  @pre place() was called
  void matrix(RateMatrix& R) const;

  /// max_j |c_hat_j| sum_k W_k, as in Model I. That steps of ssprk3 of its inverse are stable is measured.
  double strongest_decay() const {
    double strongest = 0.0;
    for (std::ptrdiff_t j = 0; j < std::ssize(this->c_hat_); ++j) {
      double sum = 0.0;
      for (const double W : this->weights(j)) sum += W;
      strongest = std::max(strongest, std::abs(this->c_hat_[j]) * sum);
    }
    return strongest;
  }
};

/// The same with a limiter: what slopes add is clipped to between nothing and the difference p = g_j - g_i itself.
/// Each term is then between 0 and 2 W_k p: forward Euler makes no new extreme of u at constant c while
/// 2 dt max_j |c_hat_j| sum_k W_k <= 1. It is not linear, so that it has no matrix; at smooth extremes it loses order.
template <Kernel K, class Divergence>
class ClippedSlopes : public SlopesPlaced<K, Divergence> {
 public:
  using SlopesPlaced<K, Divergence>::SlopesPlaced;

  /// du_j = rate_j(u), j = 0 .. N-1.  @pre place() was called
  void rate(PeriodicArray& u, std::span<double> du) {
    this->rate_by(u, du, [](double p, double a, double b) {
      const double low = std::min(0.0, p), high = std::max(0.0, p);
      return p + (std::clamp(a, low, high) - std::clamp(b, low, high));
    });
  }
};

template <Kernel K, class Divergence>
void Slopes<K, Divergence>::matrix(RateMatrix& R) const {
  const std::ptrdiff_t n = std::ssize(this->c_hat_), width = std::min(2 * this->reach() + 1, n);
  std::vector<double> row(n, 0.0);  // by column, of what multiplies g
  const auto entry = [&](std::ptrdiff_t i) -> double& { return row[(i % n + n) % n]; };
  const auto add_slope = [&](std::ptrdiff_t i, double factor) {
    this->slopes_.for_each((i % n + n) % n, [&](std::ptrdiff_t k, double C) {
      entry(i + k) += factor * C;
      entry(i) -= factor * C;
    });
  };
  R.clear();
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    const std::ptrdiff_t s = this->looks_left(j) ? +1 : -1, begin = this->offset_[j];
    for (std::ptrdiff_t k = 1; k <= this->offset_[j + 1] - begin; ++k) {
      const double W = this->weights_[begin + k - 1], carried = 0.5 * W * this->distances_[begin + k - 1];
      entry(j) -= s * W;
      entry(j - s * k) += s * W;
      add_slope(j, -carried);
      add_slope(j - s * k, carried);
    }
    const std::ptrdiff_t first = j - width / 2;
    for (std::ptrdiff_t i = first; i < first + width; ++i) {
      double value = entry(i) * this->c_hat_[(i % n + n) % n];
      if constexpr (!SlopesPlaced<K, Divergence>::standing) value -= i == j ? this->b_prime_[j] : 0.0;
      R.add((i % n + n) % n, n, value);
      entry(i) = 0.0;
    }
    R.end_row();
  }
}

}  // namespace acstudy
