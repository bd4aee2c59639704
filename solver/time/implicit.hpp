#pragma once

/// @file
/// The linear systems of implicit integrators.

#include <memory>
#include <span>

#include "solver/rate_matrix.hpp"

namespace acstudy {

/// Solves U - scale R U = g directly: R is a periodic band, as wide as the windows of the particles.
class ImplicitSolver {
 public:
  ImplicitSolver();
  ~ImplicitSolver();

  /// Factorizes I - scale R.  @throws std::domain_error if it is singular or not finite
  void factorize(const RateMatrix& R, double scale);

  /// g <- U, shape [N].  @pre factorize() was called for N particles
  void solve(std::span<double> g);

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

}  // namespace acstudy
