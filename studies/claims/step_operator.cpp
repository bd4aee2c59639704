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

namespace {

/// Columns c .. c + count - 1 of R U. A few sums at a time do not wait for one another as one sum of many terms does.
template <Eigen::Index count>
void multiply_columns(const SparseMatrix& R, const Eigen::MatrixXd& U, Eigen::Index c, std::span<double> du) {
  const Eigen::Index N = U.rows();
  for (Eigen::Index i = 0; i < N; ++i) {
    double sum[count] = {};
    for (SparseMatrix::InnerIterator entry(R, i); entry; ++entry) {
      for (Eigen::Index k = 0; k < count; ++k) sum[k] += entry.value() * U(entry.col(), c + k);
    }
    for (Eigen::Index k = 0; k < count; ++k) du[static_cast<std::size_t>((c + k) * N + i)] = sum[k];
  }
}

}  // namespace

void MatrixSystem::rate(double t, MatrixSystem&, std::span<double> du) const {
  const SparseMatrix& R = rates_(t);
  Eigen::Index c = 0;
  for (; c + 4 <= U_.cols(); c += 4) multiply_columns<4>(R, U_, c, du);
  for (; c < U_.cols(); ++c) multiply_columns<1>(R, U_, c, du);
}

void MatrixSystem::solve(double t, double scale, MatrixSystem&) {
  const Eigen::MatrixXd A = Eigen::MatrixXd::Identity(U_.rows(), U_.rows()) - scale * Eigen::MatrixXd(rates_(t));
  U_ = A.partialPivLu().solve(U_).eval();
}

Eigen::MatrixXd step_operator(const Integrator& integrator, const SparseMatrix& R, double dt) {
  Eigen::MatrixXd S = Eigen::MatrixXd::Identity(R.rows(), R.rows());
  const RatesAt rates = [&](double) -> const SparseMatrix& { return R; };
  MatrixSystem system(rates, S);
  Stepper(integrator, system.values().size())({.begin = 0.0, .end = dt, .dt = dt}, system, system);
  return S;
}

namespace {

/// u' = z u of one complex unknown.
struct ComplexSystem {
  std::complex<double> z;
  void rate(double, std::span<double>& u, std::span<double> du) const { put(z * complex(u), du); }
  void solve(double, double scale, std::span<double>& u) const { put(complex(u) / (1.0 - scale * z), u); }

  static std::complex<double> complex(std::span<const double> u) { return {u[0], u[1]}; }
  static void put(std::complex<double> value, std::span<double> u) {
    u[0] = value.real();
    u[1] = value.imag();
  }
};

}  // namespace

std::complex<double> stability_function(const Integrator& integrator, std::complex<double> z) {
  double value[] = {1.0, 0.0};
  std::span<double> u = value;
  const ComplexSystem system{z};
  Stepper(integrator, u.size())({.begin = 0.0, .end = 1.0, .dt = 1.0}, u, system);
  return ComplexSystem::complex(u);
}

double monotonicity_radius(const Integrator& integrator) {
  double radius = std::numeric_limits<double>::infinity();
  if (integrator.implicit()) {
    const std::size_t last = integrator.stage_count();
    if (last > 2) return 0.0;
    return last == 1 ? radius : 1.0 / (integrator.stage(last).beta[1] - integrator.diagonal(last));
  }
  for (const Stage& stage : integrator.stages) {
    for (std::size_t k = 0; k < most_stages; ++k) {
      if (stage.beta[k] != 0.0) radius = std::min(radius, stage.alpha[k] / stage.beta[k]);
    }
  }
  return radius;
}

double max_norm(const Eigen::MatrixXd& matrix) {
  const double norm = matrix.cwiseAbs().rowwise().sum().maxCoeff();
  // maxCoeff may pass over a NaN; a sum does not.
  return std::isfinite(matrix.sum()) && norm < largest_norm ? norm : largest_norm;
}

Eigen::MatrixXd product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) { return A * B; }

double norm_of_power(Eigen::MatrixXd S, std::int64_t n) {
  Eigen::MatrixXd power = Eigen::MatrixXd::Identity(S.rows(), S.rows());
  for (; n > 0; n /= 2) {
    if (n % 2 == 1) power = product(S, power);
    if (n > 1) S = product(S, S);
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
