#pragma once

/// @file
/// Controls, not schemes: Model II with one mistake. A study that does not notice is no evidence.

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

/// Role of a mistake in Model II: the decisions of the scheme, one of them wrong.
///
/// | expression                         | meaning                                      |
/// |------------------------------------|----------------------------------------------|
/// | `renormalization(N_j)`             | what the sums are divided by                 |
/// | `viscous_factor(mu, delta, reach)` | what D_j is multiplied by                    |
struct RightModelII {
  static double renormalization(double N_j) { return N_j; }
  static double viscous_factor(double mu, double, double reach) { return mu * reach; }
};

/// The first moment stays what the arrangement of the particles makes it.
struct NoRenormalization : RightModelII {
  static double renormalization(double) { return 1.0; }
};

/// A centered sum: consistent, and not stable.
struct NoViscosity : RightModelII {
  static double viscous_factor(double, double, double) { return 0.0; }
};

/// Less viscosity than Lemma 3.3 asks for.
struct HalfViscosity : RightModelII {
  static double viscous_factor(double mu, double, double reach) { return 0.5 * mu * reach; }
};

/// The horizon in the place of the reach: what is left below the spacing is too little.
struct HorizonViscosity : RightModelII {
  static double viscous_factor(double mu, double delta, double) { return mu * delta; }
};

/// The smoothing length of the spline, half its support, in the place of the reach.
struct HalfHorizonViscosity : RightModelII {
  static double viscous_factor(double mu, double delta, double) { return 0.5 * mu * delta; }
};

/// (3.6), (3.8) and (3.10) as they are printed, sum by sum; with RightModelII they are `ModelII`, slower.
template <IntegrableKernel K, class Divergence, class Mistake = RightModelII>
class ModelII {
 public:
  ModelII(K kernel, double mu) : kernel_(kernel), mu_(mu) {}

  template <AdvectionVelocity V>
  void place(const Particles& particles, const V& velocity) {
    particles_ = &particles;
    const Windows& windows = particles.windows;
    const PeriodicArray& x = particles.x;
    first_.assign(1, 0);
    std::vector<double> middle;
    for (std::ptrdiff_t j = 0; j < std::ssize(x); ++j) {
      for_each_neighbor(windows, j, [&](std::ptrdiff_t i) { middle.push_back(0.5 * (x[j] + x[i])); });
      first_.push_back(middle.size());
    }
    c_hat_.resize(middle.size());
    velocity.c(middle, c_hat_);
    if constexpr (!standing) {
      b_.resize(middle.size());
      velocity.b(middle, b_);
      for (std::size_t p = 0; p < middle.size(); ++p) c_hat_[p] -= b_[p];
      b_prime_.resize(x.size());
      velocity.b_prime(x.values(), b_prime_);
    }
    ++work_.weight_builds;
  }

  /// @pre place() was called, and its particles are still there; wraps the ghosts of `u`
  void rate(PeriodicArray& u, std::span<double> du) {
    const Windows& windows = particles_->windows;
    const PeriodicArray& x = particles_->x;
    u.wrap(windows.widest);
    for (std::ptrdiff_t j = 0; j < std::ssize(u); ++j) {
      const std::vector<double> W = weights(j);
      double N_j = 0.0, A = 0.0, D = 0.0, B = 0.0, reach = particles_->delta;
      std::size_t k = 0, p = first_[static_cast<std::size_t>(j)];
      for_each_neighbor(windows, j, [&](std::ptrdiff_t i) {
        N_j += (x[i] - x[j]) * W[k];
        A += c_hat_[p] * (u[j] + u[i]) * W[k];
        D += (u[i] - u[j]) / (x[i] - x[j]) * W[k];
        if constexpr (std::is_same_v<Divergence, NonlocalDivergence>) B += 2.0 * b_[p] * W[k];
        reach = std::max(reach, std::abs(x[i] - x[j]));
        ++k, ++p;
      });
      du[j] =
          (-A + Mistake::viscous_factor(mu_, particles_->delta, reach) * D - B * u[j]) / Mistake::renormalization(N_j);
      if constexpr (std::is_same_v<Divergence, LocalDivergence>) du[j] -= b_prime_[static_cast<std::size_t>(j)] * u[j];
      work_.pairs += std::ssize(W);
    }
  }

  /// W_{j,k} for k = -l_j .. -1, 1 .. r_j.
  std::vector<double> weights(std::ptrdiff_t j) const {
    const auto at = static_cast<std::size_t>(j);
    const int l = particles_->windows.left[at], r = particles_->windows.right[at];
    std::vector<double> W = cells(j, -1, l);
    std::reverse(W.begin(), W.end());
    const std::vector<double> right = cells(j, +1, r);
    W.insert(W.end(), right.begin(), right.end());
    return W;
  }

  /// What the sums of particle j are divided by.
  double renormalization(std::ptrdiff_t j) const {
    const std::vector<double> W = weights(j);
    double N_j = 0.0;
    std::size_t k = 0;
    for_each_neighbor(particles_->windows, j,
                      [&](std::ptrdiff_t i) { N_j += (particles_->x[i] - particles_->x[j]) * W[k++]; });
    return Mistake::renormalization(N_j);
  }

  const WorkCounts& work() const { return work_; }

 private:
  static constexpr bool standing = std::is_same_v<Divergence, NoDivergence>;

  template <class Visit>
  static void for_each_neighbor(const Windows& windows, std::ptrdiff_t j, Visit&& visit) {
    const auto at = static_cast<std::size_t>(j);
    for (std::ptrdiff_t i = j - windows.left[at]; i <= j + windows.right[at]; ++i) {
      if (i != j) visit(i);
    }
  }

  /// W of the neighbors on one side, nearest first.
  std::vector<double> cells(std::ptrdiff_t j, int side, int count) const {
    const double delta = particles_->delta;
    std::vector<double> W;
    double inner = 0.0;
    for (int k = 1; k <= count; ++k) {
      const double d = side * (particles_->x[j + side * k] - particles_->x[j]);
      const double outer = kernel_.mass(k < count ? std::min(d / delta, 1.0) : 1.0);
      W.push_back(side * (outer - inner) / (2.0 * delta));
      inner = outer;
    }
    return W;
  }

  K kernel_;
  double mu_;
  const Particles* particles_ = nullptr;
  std::vector<std::size_t> first_;  ///< of the pairs of a particle
  std::vector<double> c_hat_, b_;   ///< at the midpoint of each pair
  std::vector<double> b_prime_;     ///< at the particles
  WorkCounts work_;
};

}  // namespace acstudy::controls
