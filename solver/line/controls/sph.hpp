#pragma once

/// @file
/// A control, not a scheme: the classical SPH sum, which converges only if delta/h grows under refinement.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "solver/kernels.hpp"
#include "solver/line/particles.hpp"
#include "solver/velocity.hpp"

namespace acstudy::controls {

/// Point values of the kernel times particle volumes, V_i = half the distance between both neighbors of i:
///
///     du_j/dt = - b'_j u_j - sum_i V_i (c_hat_j u_j + c_hat_i u_i) w_ij + delta mu sum_i V_i (u_i - u_j)/(x_i - x_j)
///     w_ij
///
/// with w_ij = w^delta(x_i - x_j), 0 beyond the horizon. Neither renormalized nor integrated over cells.
template <Kernel K, class Divergence>
class ClassicalSph {
  static_assert(!std::is_same_v<Divergence, NonlocalDivergence>, "the textbook sum has an exact b'");

 public:
  /// @param mu  0 for the sum without viscosity
  ClassicalSph(K kernel, double mu) : kernel_(kernel), mu_(mu) {}

  template <AdvectionVelocity V>
  void place(const Particles& particles, const V& velocity) {
    particles_ = &particles;
    const auto x = particles.x.values();
    c_hat_ = PeriodicArray(x.size());
    velocity.c(x, c_hat_.values());
    if constexpr (!standing) {
      std::vector<double> b(x.size());
      velocity.b(x, b);
      for (std::size_t j = 0; j < x.size(); ++j) c_hat_.values()[j] -= b[j];
      b_prime_.resize(x.size());
      velocity.b_prime(x, b_prime_);
    }
    c_hat_.wrap(particles.windows.widest);
    volume_ = PeriodicArray(x.size());
    for (std::ptrdiff_t j = 0; j < std::ssize(x); ++j) volume_[j] = 0.5 * (particles.x[j + 1] - particles.x[j - 1]);
    volume_.wrap(particles.windows.widest);
    ++work_.weight_builds;
  }

  /// @pre place() was called, and its particles are still there; wraps the ghosts of `u`
  void rate(PeriodicArray& u, std::span<double> du) {
    const Windows& windows = particles_->windows;
    const PeriodicArray& x = particles_->x;
    u.wrap(windows.widest);
    for (std::ptrdiff_t j = 0; j < std::ssize(u); ++j) {
      const auto at = static_cast<std::size_t>(j);
      double A = 0.0, D = 0.0;
      for (std::ptrdiff_t i = j - windows.left[at]; i <= j + windows.right[at]; ++i) {
        if (i == j) continue;
        const double W = weight(j, i);
        A += (c_hat_[j] * u[j] + c_hat_[i] * u[i]) * W;
        D += (u[i] - u[j]) / (x[i] - x[j]) * W;
      }
      du[j] = -A + particles_->delta * mu_ * D;
      if constexpr (!standing) du[j] -= b_prime_[at] * u[j];
      work_.pairs += windows.left[at] + windows.right[at];
    }
  }

  /// V_i w_ij for k = -l_j .. -1, 1 .. r_j.
  std::vector<double> weights(std::ptrdiff_t j) const {
    const auto at = static_cast<std::size_t>(j);
    std::vector<double> W;
    for (std::ptrdiff_t i = j - particles_->windows.left[at]; i <= j + particles_->windows.right[at]; ++i) {
      if (i != j) W.push_back(weight(j, i));
    }
    return W;
  }
  double renormalization(std::ptrdiff_t) const { return 1.0; }

  const WorkCounts& work() const { return work_; }

 private:
  static constexpr bool standing = std::is_same_v<Divergence, NoDivergence>;

  double weight(std::ptrdiff_t j, std::ptrdiff_t i) const {
    const double delta = particles_->delta, offset = particles_->x[i] - particles_->x[j], z = std::abs(offset) / delta;
    return z < 1.0 ? volume_[i] * std::copysign(kernel_.eta(z) / (2.0 * delta * delta), offset) : 0.0;
  }

  K kernel_;
  double mu_;
  const Particles* particles_ = nullptr;
  PeriodicArray c_hat_, volume_;
  std::vector<double> b_prime_;
  WorkCounts work_;
};

}  // namespace acstudy::controls
