#pragma once

/// @file
/// Model I: upwind kernel. Stationary (2.4), moving with local (2.9) or nonlocal divergence (2.11), both sides.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "solver/kernels.hpp"
#include "solver/line/particles.hpp"
#include "solver/rate_matrix.hpp"
#include "solver/velocity.hpp"

namespace acstudy {

/// W_1 .. W_L of one particle that looks left (s = +1) or right (s = -1), nearest neighbor first; see ModelI.
///
/// @param x  at the particle; its neighbors are x[-s k]
template <int s, Kernel K>
void upwind_weights(const K& kernel, const double* x, double delta, std::span<double> W) {
  const std::ptrdiff_t L = std::ssize(W);
  CellWalk cells(delta);
  for (std::ptrdiff_t k = 1; k < L; ++k) {
    const double d = s * (x[0] - x[-s * k]), gap = s * (x[-s * (k - 1)] - x[-s * k]);
    W[k - 1] = kernel.first_moment(cells.to(d, gap)) / d;
  }
  W[L - 1] = kernel.first_moment(cells.to_horizon()) / (s * (x[0] - x[-s * L]));
}

/// Semidiscrete Model I, without the source: du_j/dt = rate_j(u).
///
/// With s = +1 where c_hat_j > 0 (look left) and s = -1 otherwise (look right), neighbor k of particle j is i = j - s k
/// at distance d_k = s (x_j - x_i), and with m(a, b) = int_a^b s eta^delta(s) ds
///
///     W_k = [ m(d_{k-1}, d_k) + 1_{k=L} m(d_L, delta) ] / d_k,     sum_k d_k W_k = 1, W_k >= 0     (Remark 2.2)
///     (2.4)   rate_j =            - s sum_k (c_j u_j - c_i u_i) W_k
///     (2.9)   rate_j = - b'_j u_j - s sum_k (c_hat_j u_j - c_hat_i u_i) W_k
///     (2.11)  rate_j =            - s sum_k ((c_j - b_i) u_j - c_hat_i u_i) W_k
///
/// Stability (Lemma 2.4): dt max|c_hat| / h_min <= 1, whatever the horizon.
template <Kernel K, class Divergence>
class ModelI {
 public:
  explicit ModelI(K kernel) : kernel_(kernel) {}

  /// Computes velocities and weights for the particles where they are now.
  template <AdvectionVelocity V>
  void place(const Particles& particles, const V& velocity);

  /// du_j = rate_j(u), j = 0 .. N-1.  @pre place() was called; wraps the ghosts of `u`.
  void rate(PeriodicArray& u, std::span<double> du);

  /// The matrix of the rates.  @pre place() was called
  void matrix(RateMatrix& R) const;

  /// max_j |c_hat_j| sum_k W_k: a forward Euler step of at most its inverse keeps every transported value's own weight
  /// nonnegative, which is what the proof of Lemma 2.4 needs of each row.
  double strongest_decay() const;

  /// W_1 .. W_L of particle j, nearest first.
  std::span<const double> weights(std::ptrdiff_t j) const {
    return {weights_.data() + offset_[j], weights_.data() + offset_[j + 1]};
  }
  /// True if particle j looks to its left.
  bool looks_left(std::ptrdiff_t j) const { return c_hat_[j] > 0.0; }

  const WorkCounts& work() const { return work_; }

 private:
  struct Nothing {};
  struct LocalTerm {
    std::vector<double> b_prime;
  };
  struct NonlocalTerm {
    std::vector<double> c;
    PeriodicArray b;
  };
  static constexpr bool standing = std::is_same_v<Divergence, NoDivergence>;
  static constexpr bool local = std::is_same_v<Divergence, LocalDivergence>;
  static constexpr bool nonlocal = std::is_same_v<Divergence, NonlocalDivergence>;
  using Term = std::conditional_t<standing, Nothing, std::conditional_t<local, LocalTerm, NonlocalTerm>>;

  template <AdvectionVelocity V>
  void set_velocities(const Particles& particles, const V& velocity);

  template <int s>
  double upwind_sum(std::ptrdiff_t j, const PeriodicArray& u) const;

  K kernel_;
  PeriodicArray c_hat_;
  [[no_unique_address]] Term divergence_;
  std::vector<std::ptrdiff_t> offset_;
  std::vector<double> weights_;
  int widest_ = 0;
  WorkCounts work_;
};

template <Kernel K, class Divergence>
template <AdvectionVelocity V>
void ModelI<K, Divergence>::place(const Particles& particles, const V& velocity) {
  const auto n = std::ssize(particles.x);
  widest_ = particles.windows.widest;
  set_velocities(particles, velocity);

  offset_.resize(n + 1);
  offset_[0] = 0;
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    offset_[j + 1] = offset_[j] + (looks_left(j) ? particles.windows.left[j] : particles.windows.right[j]);
  }
  weights_.resize(offset_[n]);
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    const double* const x = particles.x.at(j);
    const std::span<double> W(weights_.data() + offset_[j], weights_.data() + offset_[j + 1]);
    looks_left(j) ? upwind_weights<+1>(kernel_, x, particles.delta, W)
                  : upwind_weights<-1>(kernel_, x, particles.delta, W);
  }
  ++work_.weight_builds;
}

template <Kernel K, class Divergence>
template <AdvectionVelocity V>
void ModelI<K, Divergence>::set_velocities(const Particles& particles, const V& velocity) {
  const auto x = particles.x.values();
  if (c_hat_.size() != x.size()) c_hat_ = PeriodicArray(x.size());
  const auto c_hat = c_hat_.values();
  velocity.c(x, c_hat);
  work_.velocity_evaluations += std::ssize(x);

  if constexpr (!standing) {
    std::vector<double> b(x.size());
    velocity.b(x, b);
    if constexpr (local) {
      divergence_.b_prime.resize(x.size());
      velocity.b_prime(x, divergence_.b_prime);
    } else {
      divergence_.c.assign(c_hat.begin(), c_hat.end());
      if (divergence_.b.size() != x.size()) divergence_.b = PeriodicArray(x.size());
      std::copy(b.begin(), b.end(), divergence_.b.values().begin());
      divergence_.b.wrap(widest_);
    }
    for (std::size_t j = 0; j < x.size(); ++j) c_hat[j] -= b[j];
    work_.velocity_evaluations += (local ? 2 : 1) * std::ssize(x);
  }
  c_hat_.wrap(widest_);
}

template <Kernel K, class Divergence>
template <int s>
double ModelI<K, Divergence>::upwind_sum(std::ptrdiff_t j, const PeriodicArray& u_) const {
  const std::ptrdiff_t L = offset_[j + 1] - offset_[j];
  const double* const W = weights_.data() + offset_[j];
  const double* const u = u_.at(j);
  const double* const c_hat = c_hat_.at(j);
  double sum = 0.0;
  if constexpr (nonlocal) {
    const double c_j = divergence_.c[j];
    const double* const b = divergence_.b.at(j);
#pragma omp simd reduction(+ : sum)
    for (std::ptrdiff_t k = 1; k <= L; ++k) {
      sum += ((c_j - b[-s * k]) * u[0] - c_hat[-s * k] * u[-s * k]) * W[k - 1];
    }
  } else {
#pragma omp simd reduction(+ : sum)
    for (std::ptrdiff_t k = 1; k <= L; ++k) {
      sum += (c_hat[0] * u[0] - c_hat[-s * k] * u[-s * k]) * W[k - 1];
    }
  }
  return s * sum;
}

template <Kernel K, class Divergence>
void ModelI<K, Divergence>::matrix(RateMatrix& R) const {
  const std::ptrdiff_t n = std::ssize(c_hat_);
  R.clear();
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    const std::ptrdiff_t s = looks_left(j) ? +1 : -1;
    double own = 0.0;
    if constexpr (local) own -= divergence_.b_prime[j];
    for (std::ptrdiff_t k = 1; k <= offset_[j + 1] - offset_[j]; ++k) {
      const double W = weights_[offset_[j] + k - 1];
      if constexpr (nonlocal) {
        own -= s * (divergence_.c[j] - divergence_.b[j - s * k]) * W;
      } else {
        own -= s * c_hat_[j] * W;
      }
      R.add(j - s * k, n, s * c_hat_[j - s * k] * W);
    }
    R.add(j, n, own);
    R.end_row();
  }
}

template <Kernel K, class Divergence>
double ModelI<K, Divergence>::strongest_decay() const {
  double strongest = 0.0;
  for (std::ptrdiff_t j = 0; j < std::ssize(c_hat_); ++j) {
    double sum = 0.0;
    for (const double W : weights(j)) sum += W;
    strongest = std::max(strongest, std::abs(c_hat_[j]) * sum);
  }
  return strongest;
}

template <Kernel K, class Divergence>
void ModelI<K, Divergence>::rate(PeriodicArray& u, std::span<double> du) {
  u.wrap(widest_);
  for (std::ptrdiff_t j = 0; j < std::ssize(u); ++j) {
    du[j] = -(looks_left(j) ? upwind_sum<+1>(j, u) : upwind_sum<-1>(j, u));
    if constexpr (local) du[j] -= divergence_.b_prime[j] * u[j];
  }
  work_.pairs += std::ssize(weights_);
}

}  // namespace acstudy
