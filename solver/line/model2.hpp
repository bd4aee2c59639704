#pragma once

/// @file
/// Model II: renormalized SPH with vanishing nonlocal viscosity. Stationary (3.6), moving with local (3.8) or nonlocal
/// divergence (3.10).

#include <algorithm>
#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "solver/kernels.hpp"
#include "solver/line/particles.hpp"
#include "solver/rate_matrix.hpp"
#include "solver/velocity.hpp"

namespace acstudy {

/// The integrals m_k of eta over the cells of one particle on its right (side = +1) or left (side = -1), in units of
/// the horizon. They are 2 delta |W_{j,k}|; see ModelII.
///
/// @param x  at the particle; its neighbors are x[side k], k = 1 .. last
/// @param m  m_k is written to m[side (k - 1)]
/// @return   sum_k d_k m_k, the part of this side in 2 delta N_j
template <int side, IntegrableKernel K>
double set_masses(const K& kernel, const double* x, double delta, std::ptrdiff_t last, double* m) {
  double moment = 0.0;
  CellWalk cells(delta);
  for (std::ptrdiff_t k = 1; k < last; ++k) {
    const double d = side * (x[side * k] - x[0]), gap = side * (x[side * k] - x[side * (k - 1)]);
    const double mass = m[side * (k - 1)] = kernel.mass(cells.to(d, gap));
    moment += d * mass;
  }
  const double mass = m[side * (last - 1)] = kernel.mass(cells.to_horizon());
  return moment + side * (x[side * last] - x[0]) * mass;
}

/// Semidiscrete Model II, without the source: du_j/dt = rate_j(u).
///
/// W_{j,k} is the integral of w^delta(y - x_j) over the cell between neighbors k - 1 and k, the outermost cell reaching
/// to the horizon; negative for k < 0. Over k = -l_j .. r_j, k != 0, with i = j + k:
///
///     N_j = sum_k (x_i - x_j) W_{j,k}                              N_j - 1 = O(h/delta), sum_k W_{j,k} = 0 (3.4)
///     A_j = (1/N_j) sum_k c_hat((x_j + x_i)/2) (u_j + u_i) W_{j,k}
///     D_j = (1/N_j) sum_k (u_i - u_j)/(x_i - x_j) W_{j,k}
///     B_j = (2/N_j) sum_k b((x_j + x_i)/2) W_{j,k}
///     reach_j = max(delta, x_j - x_{j-l_j}, x_{j+r_j} - x_j)
///
///     (3.6)   rate_j =            - A_j + mu reach_j D_j            c in place of c_hat
///     (3.8)   rate_j = - b'_j u_j - A_j + mu reach_j D_j
///     (3.10)  rate_j = - B_j u_j  - A_j + mu reach_j D_j
///
/// Stability: dt mu max_j (reach_j/N_j) sum_k W_{j,k}/(x_i - x_j) <= 1 with mu >= max|c_hat| bounds the max norm of a
/// step. Lemma 3.3 prints 2 dt mu / h_min <= 1, which is enough for the cubic spline on equal gaps but not for kernels
/// close to singular (power family, alpha = 0.9) nor for every uneven arrangement; see docs/equations.md.
template <IntegrableKernel K, class Divergence>
class ModelII {
 public:
  /// @param mu  viscosity bound, mu >= max|c_hat|
  ModelII(K kernel, double mu) : kernel_(kernel), mu_(mu) {}

  /// Computes midpoint velocities and weights for the particles where they are now.
  template <AdvectionVelocity V>
  void place(const Particles& particles, const V& velocity);

  /// du_j = rate_j(u), j = 0 .. N-1.  @pre place() was called; wraps the ghosts of `u`.
  void rate(PeriodicArray& u, std::span<double> du);

  /// The matrix of the rates.  @pre place() was called
  void matrix(RateMatrix& R) const;

  /// mu max_j (reach_j/N_j) sum_k W_{j,k}/(x_i - x_j), the inverse of the largest forward Euler step above.
  double strongest_decay() const;

  /// W_{j,k} for k = -l_j .. -1, 1 .. r_j.
  std::vector<double> weights(std::ptrdiff_t j) const {
    std::vector<double> W(masses_.data() + offset_[j], masses_.data() + offset_[j + 1]);
    for (double& W_k : W) W_k /= 2.0 * delta_;
    return W;
  }
  /// N_j.
  double renormalization(std::ptrdiff_t j) const { return moments_[j] / (2.0 * delta_); }

  const WorkCounts& work() const { return work_; }

 private:
  static constexpr bool standing = std::is_same_v<Divergence, NoDivergence>;
  static constexpr bool local = std::is_same_v<Divergence, LocalDivergence>;
  static constexpr bool nonlocal = std::is_same_v<Divergence, NonlocalDivergence>;

  struct Nothing {};
  struct DivergenceTerm {
    std::vector<double> factor;  ///< b'_j or B_j
  };
  struct MidpointParticleVelocity {
    std::vector<double> b;
  };

  /// The pairs (j, j+k), k = 1 .. r_j, each stored once: what both of its particles need.
  struct Pairs {
    std::vector<std::ptrdiff_t> offset;
    std::vector<double> distance, inverse_distance, midpoint, c_hat;
    [[no_unique_address]] std::conditional_t<standing, Nothing, MidpointParticleVelocity> particle_velocity;
  };

  template <AdvectionVelocity V>
  void set_pairs(const Particles& particles, const V& velocity);
  void set_weights(std::ptrdiff_t j, const Particles& particles);

  struct Sums {
    double moment = 0.0, B = 0.0;
  };
  /// Fills m, m/(x_i - x_j) and c_hat for the neighbors on one side and returns their part of the moment and of
  /// sum b m.
  template <int side>
  Sums set_side(std::ptrdiff_t j, int last, const Particles& particles);

  // W_{j,k} = m_{j,k}/(2 delta), and N_j likewise: every rate is a quotient in which 1/(2 delta) cancels, so it is not
  // put in. At a horizon of 1e-200 it would overflow.
  K kernel_;
  double mu_, delta_ = 0.0;
  Pairs pairs_;
  std::vector<std::ptrdiff_t> offset_;
  std::vector<int> left_;
  std::vector<double> masses_;  ///< m_{j,k} = 2 delta W_{j,k}, k = -l_j .. -1, 1 .. r_j, particle after particle
  std::vector<double> slopes_;  ///< m_{j,k} / (x_i - x_j)
  std::vector<double> midpoint_c_hat_;  ///< c_hat((x_j + x_i)/2)
  std::vector<double> moments_;         ///< 2 delta N_j
  std::vector<double> reach_;
  [[no_unique_address]] std::conditional_t<standing, Nothing, DivergenceTerm> divergence_;
  int widest_ = 0;
  WorkCounts work_;
};

template <IntegrableKernel K, class Divergence>
template <AdvectionVelocity V>
void ModelII<K, Divergence>::place(const Particles& particles, const V& velocity) {
  const auto n = std::ssize(particles.x);
  widest_ = particles.windows.widest;
  left_ = particles.windows.left;
  delta_ = particles.delta;
  set_pairs(particles, velocity);

  offset_.resize(n + 1);
  offset_[0] = 0;
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    offset_[j + 1] = offset_[j] + particles.windows.left[j] + particles.windows.right[j];
  }
  for (auto* column : {&masses_, &slopes_, &midpoint_c_hat_}) column->resize(offset_[n]);
  for (auto* column : {&moments_, &reach_}) column->resize(n);
  if constexpr (!standing) divergence_.factor.resize(n);
  if constexpr (local) {
    velocity.b_prime(particles.x.values(), divergence_.factor);
    work_.velocity_evaluations += n;
  }
  for (std::ptrdiff_t j = 0; j < n; ++j) set_weights(j, particles);
  ++work_.weight_builds;
}

template <IntegrableKernel K, class Divergence>
template <AdvectionVelocity V>
void ModelII<K, Divergence>::set_pairs(const Particles& particles, const V& velocity) {
  const auto n = std::ssize(particles.x);
  const auto& right = particles.windows.right;
  pairs_.offset.resize(n + 1);
  pairs_.offset[0] = 0;
  for (std::ptrdiff_t j = 0; j < n; ++j) pairs_.offset[j + 1] = pairs_.offset[j] + right[j];
  const auto count = static_cast<std::size_t>(pairs_.offset[n]);
  for (auto* column : {&pairs_.distance, &pairs_.inverse_distance, &pairs_.midpoint, &pairs_.c_hat})
    column->resize(count);
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    const double* const x = particles.x.at(j);
    double* const distance = pairs_.distance.data() + pairs_.offset[j];
    double* const midpoint = pairs_.midpoint.data() + pairs_.offset[j];
    for (int k = 1; k <= right[j]; ++k) {
      distance[k - 1] = x[k] - x[0];
      midpoint[k - 1] = 0.5 * (x[0] + x[k]);
    }
  }
  for (std::size_t p = 0; p < count; ++p) pairs_.inverse_distance[p] = 1.0 / pairs_.distance[p];
  velocity.c(pairs_.midpoint, pairs_.c_hat);
  work_.velocity_evaluations += std::ssize(pairs_.midpoint);
  if constexpr (!standing) {
    auto& b = pairs_.particle_velocity.b;
    b.resize(count);
    velocity.b(pairs_.midpoint, b);
    for (std::size_t p = 0; p < count; ++p) pairs_.c_hat[p] -= b[p];
    work_.velocity_evaluations += std::ssize(pairs_.midpoint);
  }
}

template <IntegrableKernel K, class Divergence>
template <int side>
typename ModelII<K, Divergence>::Sums ModelII<K, Divergence>::set_side(std::ptrdiff_t j, int last,
                                                                       const Particles& particles) {
  const auto n = std::ssize(pairs_.offset) - 1;
  const std::ptrdiff_t first = offset_[j] + left_[j] - (side < 0 ? 1 : 0);
  Sums sums;
  sums.moment = set_masses<side>(kernel_, particles.x.at(j), particles.delta, last, masses_.data() + first);
  for (int k = 1; k <= last; ++k) {
    // The pair is stored with its left particle.
    const std::ptrdiff_t i = side > 0 ? j : (j >= k ? j - k : j - k + n);
    const std::ptrdiff_t p = pairs_.offset[i] + k - 1, q = first + side * (k - 1);
    slopes_[q] = masses_[q] * pairs_.inverse_distance[p];
    masses_[q] *= side;
    midpoint_c_hat_[q] = pairs_.c_hat[p];
    if constexpr (nonlocal) sums.B += pairs_.particle_velocity.b[p] * masses_[q];
  }
  return sums;
}

template <IntegrableKernel K, class Divergence>
void ModelII<K, Divergence>::set_weights(std::ptrdiff_t j, const Particles& particles) {
  const int l = particles.windows.left[j], r = particles.windows.right[j];
  const double* const x = particles.x.at(j);
  const Sums left = set_side<-1>(j, l, particles), right = set_side<+1>(j, r, particles);
  moments_[j] = left.moment + right.moment;
  reach_[j] = std::max({particles.delta, x[0] - x[-l], x[r] - x[0]});
  if constexpr (nonlocal) divergence_.factor[j] = 2.0 / moments_[j] * (left.B + right.B);
}

template <IntegrableKernel K, class Divergence>
void ModelII<K, Divergence>::matrix(RateMatrix& R) const {
  const std::ptrdiff_t n = std::ssize(moments_);
  R.clear();
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    double own = 0.0;
    if constexpr (!standing) own -= divergence_.factor[j];
    for (std::ptrdiff_t q = offset_[j]; q < offset_[j + 1]; ++q) {
      const std::ptrdiff_t left = q - offset_[j] - left_[j], k = left < 0 ? left : left + 1;
      const double transport = -midpoint_c_hat_[q] * masses_[q], viscous = mu_ * reach_[j] * slopes_[q];
      R.add(j + k, n, (transport + viscous) / moments_[j]);
      own += (transport - viscous) / moments_[j];
    }
    R.add(j, n, own);
    R.end_row();
  }
}

template <IntegrableKernel K, class Divergence>
double ModelII<K, Divergence>::strongest_decay() const {
  double strongest = 0.0;
  for (std::ptrdiff_t j = 0; j < std::ssize(moments_); ++j) {
    double sum = 0.0;
    for (std::ptrdiff_t q = offset_[j]; q < offset_[j + 1]; ++q) sum += slopes_[q];
    strongest = std::max(strongest, mu_ * reach_[j] / moments_[j] * sum);
  }
  return strongest;
}

template <IntegrableKernel K, class Divergence>
void ModelII<K, Divergence>::rate(PeriodicArray& u_, std::span<double> du) {
  u_.wrap(widest_);
  for (std::ptrdiff_t j = 0; j < std::ssize(u_); ++j) {
    const double* const u = u_.at(j);
    double A = 0.0, D = 0.0;
    const auto sum_over = [&](std::ptrdiff_t first_neighbor, std::ptrdiff_t begin, std::ptrdiff_t end) {
      const double* const u_i = u + first_neighbor;
      const double* const m = masses_.data() + begin;
      const double* const slope = slopes_.data() + begin;
      const double* const c_hat = midpoint_c_hat_.data() + begin;
#pragma omp simd reduction(+ : A, D)
      for (std::ptrdiff_t k = 0; k < end - begin; ++k) {
        A += c_hat[k] * (u[0] + u_i[k]) * m[k];
        D += (u_i[k] - u[0]) * slope[k];
      }
    };
    const std::ptrdiff_t middle = offset_[j] + left_[j];
    sum_over(-left_[j], offset_[j], middle);
    sum_over(+1, middle, offset_[j + 1]);

    du[j] = (-A + mu_ * reach_[j] * D) / moments_[j];
    if constexpr (!standing) du[j] -= divergence_.factor[j] * u[0];
  }
  work_.pairs += std::ssize(masses_);
}

}  // namespace acstudy
