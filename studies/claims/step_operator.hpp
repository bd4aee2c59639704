#pragma once

/// @file
/// One step of an integrator as a matrix, and how it grows.

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <complex>
#include <functional>

#include "solver/time/integrate.hpp"
#include "studies/cases/subject.hpp"

namespace acstudy {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// R with rate(u) = R u, of a scheme or of a control.
SparseMatrix sparse_rates(PlacedScheme& placed);

/// R at time t.
using RatesAt = std::function<const SparseMatrix&(double t)>;

/// The columns of U, shape [N, any], as one state whose rate is R U: the system that integrate() steps.
class MatrixSystem {
 public:
  /// @param U  changed in place
  MatrixSystem(const RatesAt& rates, Eigen::MatrixXd& U) : rates_(rates), U_(U) {}
  std::span<double> values() { return {U_.data(), static_cast<std::size_t>(U_.size())}; }
  void rate(double t, MatrixSystem&, std::span<double> du) const;
  void solve(double t, double scale, MatrixSystem&);

 private:
  const RatesAt& rates_;
  Eigen::MatrixXd& U_;
};

/// S of particles that do not move during the step: a polynomial or rational function of dt R, shape [N, N].
Eigen::MatrixXd step_operator(const Integrator& integrator, const SparseMatrix& R, double dt);

/// The function r with S = r(dt R): u^{n+1} = r(z) u^n for u' = lambda u, z = lambda dt.
std::complex<double> stability_function(const Integrator& integrator, std::complex<double> z);

/// The function phi = stability_function is absolutely monotone on [-x, 0] up to this x: a step of an integrator may be
/// that many times longer than one of forward Euler. For explicit stages, convex combinations of forward Euler steps,
/// the least alpha/beta, 1 for those of this table; infinite for one implicit stage; for two, S = (I - gamma dt R)^-2
/// (I + (1 - 2 gamma) dt R) and its numerator decides; 0 for three, where phi = a w + b w^2 + c w^3, w = 1/(1 - gamma
/// z), has c < 0, so that its high derivatives are negative.
double monotonicity_radius(const Integrator& integrator);

/// Largest row sum of absolute values.
double max_norm(const Eigen::MatrixXd& matrix);

/// Norms beyond are given as this: how far beyond, nobody needs to know.
inline constexpr double largest_norm = 1e300;

/// max |S^n|, by repeated squaring.
double norm_of_power(Eigen::MatrixXd S, std::int64_t n);

/// The product of two square matrices.
Eigen::MatrixXd product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// Largest |r(dt lambda)| over the eigenvalues of R.
double spectral_radius(const Integrator& integrator, const Eigen::VectorXcd& eigenvalues, double dt);

}  // namespace acstudy
