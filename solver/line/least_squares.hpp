#pragma once

/// @file
/// Slopes at particles, by least squares over their neighbors on both sides.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "solver/line/particles.hpp"

namespace acstudy {

/// The slope at each particle of a quadratic through its own value, fitted to its neighbors on both sides:
///
///     s_j = sum_k C_k (g_i - g_j),   i = j + k, k = -l .. -1, 1 .. r
///
/// Neighbors are those within the horizon, on each side three at least: with two, steps are unstable on uneven
/// particles. Each counts as much as its cell is long; cells are bounded midway between neighbors, and the outermost
/// one reaches to the horizon, or to its particle if that is beyond. Exact for quadratics.
class LeastSquaresSlopes {
 public:
  static constexpr int fewest = 3;

  void place(const Particles& particles) {
    const Windows& windows = particles.windows;
    const auto x = particles.x.values();
    reach_ = std::max(windows.widest, fewest);
    if (x_.size() != x.size()) x_ = PeriodicArray(x.size());
    std::copy(x.begin(), x.end(), x_.values().begin());
    x_.wrap(reach_, particles.period);

    left_.resize(x.size());
    offset_.assign(1, 0);
    coefficients_.clear();
    for (std::size_t j = 0; j < x.size(); ++j) {
      left_[j] = std::max(windows.left[j], fewest);
      fit(static_cast<std::ptrdiff_t>(j), left_[j], std::max(windows.right[j], fewest), particles.delta);
      offset_.push_back(std::ssize(coefficients_));
    }
  }

  /// s_j.  @pre place() was called, and `g` is wrapped as far as reach()
  double operator()(std::ptrdiff_t j, const PeriodicArray& g_) const {
    const double* const g = g_.at(j);
    const double* const C = coefficients_.data() + offset_[j];
    const std::ptrdiff_t l = left(j), r = right(j);
    double sum = 0.0;
#pragma omp simd reduction(+ : sum)
    for (std::ptrdiff_t k = 0; k < l; ++k) sum += C[k] * (g[k - l] - g[0]);
#pragma omp simd reduction(+ : sum)
    for (std::ptrdiff_t k = 0; k < r; ++k) sum += C[l + k] * (g[k + 1] - g[0]);
    return sum;
  }

  /// Calls visit(k, C_k) for each neighbor j + k.
  template <class Visit>
  void for_each(std::ptrdiff_t j, Visit&& visit) const {
    const double* C = coefficients_.data() + offset_[j];
    for (std::ptrdiff_t k = -left(j); k <= right(j); ++k) {
      if (k != 0) visit(k, *C++);
    }
  }

  /// The most neighbors that a particle has on a side.
  int reach() const { return reach_; }
  std::ptrdiff_t pairs() const { return std::ssize(coefficients_); }

 private:
  std::ptrdiff_t left(std::ptrdiff_t j) const { return left_[j]; }
  std::ptrdiff_t right(std::ptrdiff_t j) const { return offset_[j + 1] - offset_[j] - left_[j]; }

  void fit(std::ptrdiff_t j, int l, int r, double delta) {
    const double* const x = x_.at(j);
    zeta_.clear();
    lengths_.clear();
    const double scale = std::max(x[r] - x[0], x[0] - x[-l]);
    for (std::ptrdiff_t k = -l; k <= r; ++k) {
      if (k == 0) continue;
      const std::ptrdiff_t s = k < 0 ? -1 : 1, last = k < 0 ? -l : r;
      const auto distance = [&](std::ptrdiff_t i) { return s * (x[i] - x[0]); };
      const double d = distance(k);
      const double inner = k == s ? 0.0 : 0.5 * (distance(k - s) + d);
      const double outer = k == last ? std::max(delta, d) : 0.5 * (d + distance(k + s));
      lengths_.push_back(outer - inner);
      zeta_.push_back(s * d / scale);
    }
    // In the unknowns slope and curvature, the sums of the squares' normal equations.
    double a11 = 0.0, a12 = 0.0, a22 = 0.0;
    for (std::size_t k = 0; k < zeta_.size(); ++k) {
      const double first = zeta_[k], second = 0.5 * zeta_[k] * zeta_[k];
      a11 += lengths_[k] * first * first;
      a12 += lengths_[k] * first * second;
      a22 += lengths_[k] * second * second;
    }
    const double factor = 1.0 / ((a11 * a22 - a12 * a12) * scale);
    for (std::size_t k = 0; k < zeta_.size(); ++k) {
      coefficients_.push_back(factor * lengths_[k] * zeta_[k] * (a22 - 0.5 * a12 * zeta_[k]));
    }
  }

  PeriodicArray x_;
  std::vector<int> left_;
  std::vector<std::ptrdiff_t> offset_;
  std::vector<double> coefficients_;    ///< C_k, k = -l .. -1, 1 .. r, particle after particle
  std::vector<double> zeta_, lengths_;  ///< of the particle that is being fitted: (x_i - x_j)/scale, of cells
  int reach_ = 0;
};

}  // namespace acstudy
