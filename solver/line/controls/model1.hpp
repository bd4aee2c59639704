#pragma once

/// @file
/// Controls, not schemes: Model I with one mistake. A study that does not notice is no evidence.

#include <algorithm>
#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "solver/kernels.hpp"
#include "solver/line/particles.hpp"
#include "solver/velocity.hpp"

namespace acstudy::controls {

/// Role of a mistake in Model I: the decisions of the scheme, one of them wrong.
///
/// | expression                         | meaning                                                                    |
/// |------------------------------------|----------------------------------------------------------------------------|
/// | `looks_left(c_hat)`                | the side that a particle looks to                                          |
/// | `sees(d, delta)`                   | whether a neighbor of the window at distance d counts                      |
/// | `weight(k, delta, d_in, d, last)`  | W of the cell from d_in to d, `last` being the outermost one               |
struct RightModelI {
  static bool looks_left(double c_hat) { return c_hat > 0.0; }
  static bool sees(double, double) { return true; }
  template <Kernel K>
  static double weight(const K& kernel, double delta, double d_in, double d, bool last) {
    const auto moment = [&](double distance) { return kernel.first_moment(std::min(distance / delta, 1.0)); };
    return ((last ? 1.0 : moment(d)) - moment(d_in)) / d;
  }
};

/// The outermost cell ends at its particle instead of the horizon: sum_k d_k W_k < 1.
struct NoTailWeight : RightModelI {
  template <Kernel K>
  static double weight(const K& kernel, double delta, double d_in, double d, bool) {
    return RightModelI::weight(kernel, delta, d_in, d, false);
  }
};

/// The kernel at the neighbor times the length of the cell, instead of the integral over the cell.
struct PointQuadrature : RightModelI {
  template <Kernel K>
  static double weight(const K& kernel, double delta, double d_in, double d, bool) {
    return d < delta ? kernel.eta(d / delta) / (delta * delta) * (d - d_in) : 0.0;
  }
};

/// The side from which nothing comes.
struct Downwind : RightModelI {
  static bool looks_left(double c_hat) { return !RightModelI::looks_left(c_hat); }
};

/// Only neighbors within the horizon: below the spacing the sum is empty.
struct NoNearestNeighbor : RightModelI {
  static bool sees(double d, double delta) { return d <= delta * (1.0 + horizon_tie_tolerance); }
};

/// (2.4), (2.9) and (2.11) as they are printed, sum by sum; with RightModelI they are `ModelI`, slower.
template <Kernel K, class Divergence, class Mistake = RightModelI>
class ModelI {
 public:
  explicit ModelI(K kernel) : kernel_(kernel) {}

  template <AdvectionVelocity V>
  void place(const Particles& particles, const V& velocity) {
    particles_ = &particles;
    const auto x = particles.x.values();
    const auto field = [&](auto&& fill) {
      PeriodicArray values(x.size());
      fill(values.values());
      values.wrap(particles.windows.widest);
      return values;
    };
    c_ = field([&](std::span<double> out) { velocity.c(x, out); });
    c_hat_ = c_;
    if constexpr (!standing) {
      b_ = field([&](std::span<double> out) { velocity.b(x, out); });
      b_prime_ = field([&](std::span<double> out) { velocity.b_prime(x, out); });
      c_hat_ = field([&](std::span<double> out) {
        for (std::size_t j = 0; j < out.size(); ++j) out[j] = c_.values()[j] - b_.values()[j];
      });
    }
    ++work_.weight_builds;
  }

  /// @pre place() was called, and its particles are still there; wraps the ghosts of `u`
  void rate(PeriodicArray& u, std::span<double> du) {
    u.wrap(particles_->windows.widest);
    for (std::ptrdiff_t j = 0; j < std::ssize(u); ++j) {
      const int s = looks_left(j) ? +1 : -1;
      const std::vector<double> W = weights(j);
      double sum = 0.0;
      for (std::ptrdiff_t k = 1; k <= std::ssize(W); ++k) {
        const std::ptrdiff_t i = j - s * k;
        if constexpr (std::is_same_v<Divergence, NonlocalDivergence>) {
          sum += ((c_[j] - b_[i]) * u[j] - c_hat_[i] * u[i]) * W[static_cast<std::size_t>(k - 1)];
        } else {
          sum += (c_hat_[j] * u[j] - c_hat_[i] * u[i]) * W[static_cast<std::size_t>(k - 1)];
        }
      }
      du[j] = -s * sum;
      if constexpr (std::is_same_v<Divergence, LocalDivergence>) du[j] -= b_prime_[j] * u[j];
      work_.pairs += std::ssize(W);
    }
  }

  bool looks_left(std::ptrdiff_t j) const { return Mistake::looks_left(c_hat_[j]); }

  /// W_1 .. W_L of particle j, nearest first.
  std::vector<double> weights(std::ptrdiff_t j) const {
    const Windows& windows = particles_->windows;
    const int s = looks_left(j) ? +1 : -1, L = (s > 0 ? windows.left : windows.right)[static_cast<std::size_t>(j)];
    std::vector<double> W;
    double d_in = 0.0;
    for (int k = 1; k <= L; ++k) {
      const double d = s * (particles_->x[j] - particles_->x[j - s * k]);
      if (!Mistake::sees(d, particles_->delta)) break;
      W.push_back(Mistake::weight(kernel_, particles_->delta, d_in, d, k == L));
      d_in = d;
    }
    return W;
  }

  const WorkCounts& work() const { return work_; }

 private:
  static constexpr bool standing = std::is_same_v<Divergence, NoDivergence>;

  K kernel_;
  const Particles* particles_ = nullptr;
  PeriodicArray c_, c_hat_, b_, b_prime_;
  WorkCounts work_;
};

}  // namespace acstudy::controls
