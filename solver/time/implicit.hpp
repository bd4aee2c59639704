#pragma once

/// @file
/// The linear systems of implicit integrators.

#include <memory>
#include <span>

#include "solver/rate_matrix.hpp"

namespace acstudy {

/// Solves U - scale R U = g directly: R is a periodic band, as wide as the windows of the particles.
///
/// Where I - scale R is diagonally dominant, by rows or by columns, it is eliminated row after row without pivoting;
/// elsewhere, in steps so long that what they amplify is no longer small, with partial pivoting. Windows that reach
/// once around are left to the sparse solver of Eigen. Nothing is allocated while the windows stay as wide as they are.
class ImplicitSolver {
 public:
  /// How systems are solved; tests compare the others with the last.
  enum class Method { automatic, pivoted, sparse };

  ImplicitSolver() : ImplicitSolver(Method::automatic) {}
  explicit ImplicitSolver(Method method);
  ~ImplicitSolver();
  ImplicitSolver(ImplicitSolver&&) noexcept;

  /// Factorizes I - scale R.  @throws std::domain_error if it is singular or not finite
  void factorize(const RateMatrix& R, double scale);
  /// The same for rows whose diagonal entries are given beside them, shape [N], and are zero in R.
  void factorize(const BandedMatrix& R, std::span<const double> own, double scale);

  /// g <- U, shape [N].  @pre factorize() was called for N particles
  void solve(std::span<double> g);

 private:
  struct Factors;
  void factorize_band();
  Method method_;
  std::unique_ptr<Factors> factors_;
};

}  // namespace acstudy
