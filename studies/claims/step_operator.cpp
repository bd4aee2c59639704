#include "studies/claims/step_operator.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace acstudy {

SparseMatrix sparse_rates(PlacedScheme& placed) {
  const auto n = static_cast<int>(placed.size());
  std::vector<Eigen::Triplet<double>> entries;
  if (const SchemeRows* const known = placed.scheme().rows()) {
    RateMatrix R;
    known->matrix(R);
    for (int j = 0; j < n; ++j) {
      for (std::ptrdiff_t k = R.begin[j]; k < R.begin[j + 1]; ++k) entries.emplace_back(j, R.column[k], R.value[k]);
    }
  } else {
    const PlacedScheme::Rows rows = placed.rows();
    for (int j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < rows.width; ++k) {
        const int column = (j + static_cast<int>(rows.first) + static_cast<int>(k) + n) % n;
        entries.emplace_back(j, column, rows(static_cast<std::size_t>(j), k));
      }
    }
  }
  SparseMatrix matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

void take_step(const Integrator& integrator, const RatesAt& rates, double dt, Eigen::MatrixXd& U) {
  Eigen::MatrixXd U_n, k_1;
  if (integrator.stage_count() > 1) U_n = U;
  for (const Stage& stage : integrator.stages) {
    U += dt * (rates(stage.time) * U).eval();
    if (stage.weight != 1.0) U = (1.0 - stage.weight) * U_n + stage.weight * U;
  }
  for (const ImplicitStage& stage : integrator.implicit_stages) {
    if (stage.previous != 0.0) U = U_n + stage.previous * dt * k_1;
    const double scale = stage.diagonal * dt;
    const Eigen::MatrixXd A =
        Eigen::MatrixXd::Identity(U.rows(), U.rows()) - scale * Eigen::MatrixXd(rates(stage.time));
    U = A.partialPivLu().solve(U).eval();
    if (&stage == &integrator.implicit_stages.front() && U_n.size() > 0) k_1 = (U - U_n) / scale;
  }
}

Eigen::MatrixXd step_operator(const Integrator& integrator, const SparseMatrix& R, double dt) {
  Eigen::MatrixXd S = Eigen::MatrixXd::Identity(R.rows(), R.rows());
  take_step(
      integrator, [&](double) -> const SparseMatrix& { return R; }, dt, S);
  return S;
}

std::complex<double> stability_function(const Integrator& integrator, std::complex<double> z) {
  std::complex<double> u = 1.0, k_1 = 0.0;
  for (const Stage& stage : integrator.stages) u = (1.0 - stage.weight) + stage.weight * (u + z * u);
  for (const ImplicitStage& stage : integrator.implicit_stages) {
    u = (1.0 + stage.previous * k_1) / (1.0 - stage.diagonal * z);
    if (&stage == &integrator.implicit_stages.front()) k_1 = (u - 1.0) / stage.diagonal;
  }
  return u;
}

double monotonicity_radius(const Integrator& integrator) {
  if (!integrator.implicit()) return 1.0;
  const ImplicitStage& last = integrator.implicit_stages.back();
  return last.previous == 0.0 ? std::numeric_limits<double>::infinity() : 1.0 / (last.previous - last.diagonal);
}

double max_norm(const Eigen::MatrixXd& matrix) {
  const double norm = matrix.cwiseAbs().rowwise().sum().maxCoeff();
  // maxCoeff may pass over a NaN; a sum does not.
  return std::isfinite(matrix.sum()) && norm < largest_norm ? norm : largest_norm;
}

double norm_of_power(Eigen::MatrixXd S, std::int64_t n) {
  Eigen::MatrixXd power = Eigen::MatrixXd::Identity(S.rows(), S.rows());
  for (; n > 0; n /= 2) {
    if (n % 2 == 1) power = (S * power).eval();
    if (n > 1) S = (S * S).eval();
  }
  return max_norm(power);
}

double spectral_radius(const Integrator& integrator, const Eigen::VectorXcd& eigenvalues, double dt) {
  double radius = 0.0;
  for (const std::complex<double> lambda : eigenvalues) {
    radius = std::max(radius, std::abs(stability_function(integrator, dt * lambda)));
  }
  return std::min(radius, largest_norm);
}

}  // namespace acstudy
