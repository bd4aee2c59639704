#pragma once

/// @file
/// A symmetric Model II, of second order and conservative, beyond the paper. Stationary, moving with local or nonlocal
/// divergence.

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

/// The symmetric scheme, semidiscrete and without the source. Cells are bounded midway between particles; with the
/// kernel gamma(z) = eta^delta(z) between all points of two cells, those next to each other always counted,
///
///     beta_ij = int_{cell i} int_{cell j} gamma(|x - y|) dx dy = beta_ji,     V_i = sum_j beta_ij |x_j - x_i| / 2
///     (F u)_i = sum_j beta_ij sign(x_j - x_i) c_hat((x_i + x_j)/2) (u_i + u_j)/2
///     (K u)_i = sum_j beta_ij / |x_j - x_i| (u_i - u_j)
///     E_i     = (mu/4) sum_j beta_ij / (sum_j beta_ij / |x_j - x_i|)^2
///
/// With (R u)_i = - (F u + K E K u)_i, the rates are
///
///     standing particles            du_i/dt         = (R u)_i / V_i
///     moving, local divergence      du_i/dt         = (R u)_i / V_i - b'_i u_i
///     moving, nonlocal divergence   d(V_i u_i)/dt   = (R u)_i
///
/// In the last of them the unknown is V_i u_i: V follows the particles, and V'/V takes the place of b'.
///
/// Each pair takes from one particle what it gives to the other. So without a source sum_i V_i u_i is conserved by
/// every step of every Runge-Kutta scheme, to round-off: on standing particles, and on moving ones with the nonlocal
/// divergence. With the local one it is not. On standing particles sum_i V_i u_i^2 grows by no more than exp(||c'|| t),
/// as K E K is positive semidefinite. Of second order in max(h, delta), and stable with ssprk3 up to
/// dt mu / h_min = 1, as far as was measured; nothing of that is proven.
template <IntegrableKernel K, class Divergence>
class Symmetric {
 public:
  /// @param mu  viscosity bound, mu >= max|c_hat|
  Symmetric(K kernel, double mu) : kernel_(kernel), mu_(mu) {}

  /// Computes midpoint velocities and weights for the particles where they are now.
  template <AdvectionVelocity V>
  void place(const Particles& particles, const V& velocity);

  /// Rates of the unknown: V_j u_j where carries_volumes, else u_j.  @pre place() was called
  void rate(PeriodicArray& u, std::span<double> du);

  /// The matrix of the rates.  @pre place() was called
  void matrix(RateMatrix& R) const;

  /// mu max_j (1/V_j) sum_i beta_ij / 2, which is mu / h on equal gaps below them. That steps of ssprk3 of its inverse
  /// are stable is measured.
  double strongest_decay() const;

  /// beta_ij / V_j of particle j, its neighbors from left to right, negative on the left: all whose cells are within
  /// the horizon of its own.
  std::vector<double> weights(std::ptrdiff_t j) const;
  std::ptrdiff_t neighbors_left(std::ptrdiff_t j) const;
  double renormalization(std::ptrdiff_t) const { return 1.0; }
  /// V_j.
  std::span<const double> volumes() const { return volume_; }
  /// How far from j, in particles, those are that its rate depends on: neighbors of neighbors.
  std::ptrdiff_t reach() const { return 2 * std::ptrdiff_t{widest_}; }

  const WorkCounts& work() const { return work_; }

  /// True if the unknown is V_j u_j.
  static constexpr bool carries_volumes = std::is_same_v<Divergence, NonlocalDivergence>;

 private:
  static constexpr bool standing = std::is_same_v<Divergence, NoDivergence>;
  static constexpr bool local = std::is_same_v<Divergence, LocalDivergence>;

  void set_pairs(const Particles& particles);
  template <AdvectionVelocity V>
  void set_velocities(std::span<const double> x, const V& velocity);
  /// Particle j - k.
  std::ptrdiff_t left_of(std::ptrdiff_t j, std::ptrdiff_t k) const {
    const std::ptrdiff_t n = std::ssize(volume_);
    return ((j - k) % n + n) % n;
  }
  /// Calls visit(p, i, j) for each pair p of i and a particle to its right, j = 0 .. N-1.
  template <class Visit>
  void for_each_pair(Visit&& visit) const {
    const std::ptrdiff_t n = std::ssize(volume_);
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      for (std::ptrdiff_t p = offset_[i]; p < offset_[i + 1]; ++p) visit(p, i, (i + 1 + p - offset_[i]) % n);
    }
  }

  K kernel_;
  double mu_;
  std::vector<std::ptrdiff_t> offset_;                      ///< of the pairs (i, i + k), k = 1, 2, ...
  std::vector<double> beta_, distance_, midpoint_, c_hat_;  ///< of pairs
  std::vector<double> volume_, dissipation_;                ///< V_i and E_i
  std::vector<double> b_prime_;                             ///< of the local divergence
  int widest_ = 0;
  WorkCounts work_;
};

template <IntegrableKernel K, class Divergence>
void Symmetric<K, Divergence>::set_pairs(const Particles& particles) {
  const std::ptrdiff_t n = std::ssize(particles.x);
  const double delta = particles.delta;
  // Cells closer than the horizon can belong to particles one beyond it, and their bounds to one more.
  const std::ptrdiff_t reach = particles.windows.widest + 2;
  PeriodicArray x(n), bound(n);
  std::copy_n(particles.x.values().begin(), n, x.values().begin());
  x.wrap(reach, particles.period);
  for (std::ptrdiff_t j = 0; j < n; ++j) bound[j] = 0.5 * (x[j] + x[j + 1]);
  bound.wrap(reach, particles.period);

  // int_z^1 (r - z) eta(r) dr, whose second difference is the integral over two cells. It is zero beyond the horizon,
  // and one where two cells meet.
  const auto tail = [&](double distance) {
    if (distance >= delta) return 0.0;
    CellWalk walk(delta);
    walk.to(distance, distance);
    const Cell rest = walk.to_horizon();
    return kernel_.first_moment(rest) - rest.inner * kernel_.mass(rest);
  };
  // tail() of the distances from the right bound of cell i to itself, to that of cell i + 1, ..., up to the horizon.
  const auto tails_from = [&](std::ptrdiff_t i, std::vector<double>& tails) {
    tails.clear();
    for (std::ptrdiff_t m = i; tails.empty() || bound[m] - bound[i] < delta; ++m) {
      tails.push_back(tail(bound[m] - bound[i]));
    }
  };
  std::vector<double> before, here;
  tails_from(-1, before);
  offset_.assign(1, 0);
  beta_.clear();
  distance_.clear();
  midpoint_.clear();
  widest_ = 0;
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    tails_from(i, here);
    const std::size_t count = here.size();
    here.resize(count + 1, 0.0);
    before.resize(std::max(before.size(), count + 2), 0.0);
    for (std::size_t k = 1; k <= count; ++k) {
      const std::ptrdiff_t j = i + static_cast<std::ptrdiff_t>(k);
      // Round-off must not make it negative.
      beta_.push_back(std::max(here[k - 1] - here[k] - before[k] + before[k + 1], 0.0));
      distance_.push_back(x[j] - x[i]);
      midpoint_.push_back(0.5 * (x[i] + x[j]));
    }
    widest_ = std::max(widest_, static_cast<int>(count));
    offset_.push_back(std::ssize(beta_));
    here.resize(count);
    std::swap(before, here);
  }
}

template <IntegrableKernel K, class Divergence>
template <AdvectionVelocity V>
void Symmetric<K, Divergence>::set_velocities(std::span<const double> x, const V& velocity) {
  c_hat_.resize(midpoint_.size());
  velocity.c(midpoint_, c_hat_);
  work_.velocity_evaluations += std::ssize(midpoint_);
  if constexpr (local) {
    b_prime_.resize(x.size());
    velocity.b_prime(x, b_prime_);
    work_.velocity_evaluations += std::ssize(x);
  }
  if constexpr (!standing) {
    std::vector<double> b(midpoint_.size());
    velocity.b(midpoint_, b);
    for (std::size_t p = 0; p < b.size(); ++p) c_hat_[p] -= b[p];
    work_.velocity_evaluations += std::ssize(midpoint_);
  }
}

template <IntegrableKernel K, class Divergence>
template <AdvectionVelocity V>
void Symmetric<K, Divergence>::place(const Particles& particles, const V& velocity) {
  const std::size_t n = particles.size();
  volume_.assign(n, 0.0);
  set_pairs(particles);
  set_velocities(particles.x.values(), velocity);
  std::vector<double> sum(n, 0.0), sum_per_distance(n, 0.0);
  for_each_pair([&](std::ptrdiff_t p, std::ptrdiff_t i, std::ptrdiff_t j) {
    for (const std::ptrdiff_t one : {i, j}) {
      volume_[one] += 0.5 * beta_[p] * distance_[p];
      sum[one] += beta_[p];
      sum_per_distance[one] += beta_[p] / distance_[p];
    }
  });
  dissipation_.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    dissipation_[i] = 0.25 * mu_ * sum[i] / (sum_per_distance[i] * sum_per_distance[i]);
  ++work_.weight_builds;
}

template <IntegrableKernel K, class Divergence>
void Symmetric<K, Divergence>::rate(PeriodicArray& u_, std::span<double> du) {
  const std::ptrdiff_t n = std::ssize(u_);
  std::vector<double> u(u_.values().begin(), u_.values().end()), curvature(n, 0.0);
  if constexpr (carries_volumes) {
    for (std::ptrdiff_t i = 0; i < n; ++i) u[i] /= volume_[i];
  }
  for_each_pair([&](std::ptrdiff_t p, std::ptrdiff_t i, std::ptrdiff_t j) {
    const double difference = beta_[p] / distance_[p] * (u[i] - u[j]);
    curvature[i] += difference;
    curvature[j] -= difference;
  });
  for (std::ptrdiff_t i = 0; i < n; ++i) curvature[i] *= dissipation_[i];
  std::fill(du.begin(), du.end(), 0.0);
  for_each_pair([&](std::ptrdiff_t p, std::ptrdiff_t i, std::ptrdiff_t j) {
    const double flux = beta_[p] * (0.5 * c_hat_[p] * (u[i] + u[j]) + (curvature[i] - curvature[j]) / distance_[p]);
    du[i] -= flux;
    du[j] += flux;
  });
  if constexpr (!carries_volumes) {
    for (std::ptrdiff_t i = 0; i < n; ++i) du[i] /= volume_[i];
  }
  if constexpr (local) {
    for (std::ptrdiff_t i = 0; i < n; ++i) du[i] -= b_prime_[i] * u[i];
  }
  work_.pairs += 2 * std::ssize(beta_);
}

template <IntegrableKernel K, class Divergence>
std::vector<double> Symmetric<K, Divergence>::weights(std::ptrdiff_t j) const {
  std::vector<double> W;
  for (std::ptrdiff_t k = neighbors_left(j); k >= 1; --k) W.push_back(-beta_[offset_[left_of(j, k)] + k - 1]);
  W.insert(W.end(), beta_.begin() + offset_[j], beta_.begin() + offset_[j + 1]);
  for (double& weight : W) weight /= volume_[j];
  return W;
}

template <IntegrableKernel K, class Divergence>
std::ptrdiff_t Symmetric<K, Divergence>::neighbors_left(std::ptrdiff_t j) const {
  std::ptrdiff_t k = 0;
  const auto sees = [&](std::ptrdiff_t i, std::ptrdiff_t count) { return offset_[i + 1] - offset_[i] >= count; };
  while (k < widest_ && sees(left_of(j, k + 1), k + 1)) ++k;
  return k;
}

template <IntegrableKernel K, class Divergence>
void Symmetric<K, Divergence>::matrix(RateMatrix& R) const {
  const std::ptrdiff_t n = std::ssize(volume_);
  // The pairs of each particle, on both sides: the other particle, and what K and F multiply its value with.
  struct Entry {
    std::ptrdiff_t other;
    double difference, flux;
  };
  std::vector<std::vector<Entry>> entries(n);
  for_each_pair([&](std::ptrdiff_t p, std::ptrdiff_t i, std::ptrdiff_t j) {
    const double difference = beta_[p] / distance_[p], flux = 0.5 * beta_[p] * c_hat_[p];
    entries[i].push_back({j, difference, flux});
    entries[j].push_back({i, difference, -flux});
  });
  std::vector<double> row(n, 0.0);
  const std::ptrdiff_t width = std::min(2 * reach() + 1, n);
  const auto add_curvature = [&](std::ptrdiff_t i, double factor) {
    for (const Entry& entry : entries[i]) {
      row[i] += factor * dissipation_[i] * entry.difference;
      row[entry.other] -= factor * dissipation_[i] * entry.difference;
    }
  };
  R.clear();
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    for (const Entry& entry : entries[j]) {
      row[j] -= entry.flux;
      row[entry.other] -= entry.flux;
      add_curvature(j, -entry.difference);
      add_curvature(entry.other, entry.difference);
    }
    if constexpr (local) row[j] -= b_prime_[j] * volume_[j];
    for (std::ptrdiff_t k = 0; k < width; ++k) {
      const std::ptrdiff_t i = (j - width / 2 + k + n) % n;
      R.add(i, n, row[i] / volume_[carries_volumes ? i : j]);
      row[i] = 0.0;
    }
    R.end_row();
  }
}

template <IntegrableKernel K, class Divergence>
double Symmetric<K, Divergence>::strongest_decay() const {
  std::vector<double> sum(volume_.size(), 0.0);
  for_each_pair([&](std::ptrdiff_t p, std::ptrdiff_t i, std::ptrdiff_t j) {
    sum[i] += 0.5 * beta_[p];
    sum[j] += 0.5 * beta_[p];
  });
  double strongest = 0.0;
  for (std::size_t i = 0; i < sum.size(); ++i) strongest = std::max(strongest, mu_ * sum[i] / volume_[i]);
  return strongest;
}

}  // namespace acstudy
