#pragma once

/// @file
/// What the rate of one particle is made of when it is summed as the formulas are printed: by this the schemes are
/// recomputed. Shares the kernels' closed forms with the solver, and nothing else.

#include <cmath>
#include <cstddef>
#include <vector>

#include "mms/scene.hpp"

namespace acstudy {

struct SchemeChoice;

/// A sum and the sum of its terms' absolute values, with |c| + |b| in the place of |c_hat|: round-off is a few ulps of
/// the latter.
struct PrintedRate {
  double value, size;
};

/// Particle j among particles at x, increasing within one period, with values u; both of shape [N].
struct PrintedAt {
  const SchemeChoice& scheme;
  const Scene& scene;
  double mu;
  const std::vector<double>&x, &u;
  double delta;
  std::size_t j;
};

/// A neighbor: its distance, not wrapped, and value.
struct PrintedNeighbor {
  double z, x, u;  ///< z = x_i - x_j
};

/// The neighbors within delta on the side s = +1 (left) or -1 (right), at least the nearest one; nearest first.
/// Searches all particles, O(N).
std::vector<PrintedNeighbor> printed_neighbors(const PrintedAt& at, int s);

/// Velocities at single points.
struct PrintedVelocity {
  const Scene& scene;
  double c(double x) const {
    double value = 0.0;
    scene.c({&x, 1}, {&value, 1});
    return value;
  }
  double b(double x) const {
    double value = 0.0;
    if (!scene.standing()) scene.b({&x, 1}, {&value, 1});
    return value;
  }
  double b_prime(double x) const {
    double value = 0.0;
    if (!scene.standing()) scene.b_prime({&x, 1}, {&value, 1});
    return value;
  }
  double c_hat(double x) const { return c(x) - b(x); }
  double size(double x) const { return std::abs(c(x)) + std::abs(b(x)); }
};

/// A sum and the size of its terms.
struct PrintedSum {
  double value = 0.0, size = 0.0;
  void add(double term, double size_of_term) {
    value += term;
    size += std::abs(size_of_term);
  }
};

}  // namespace acstudy
