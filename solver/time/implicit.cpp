#include "solver/time/implicit.hpp"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace acstudy {

namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

}  // namespace

struct ImplicitSolver::Factors {
  Matrix matrix;
  std::vector<Eigen::Triplet<double, int>> entries;
  Eigen::SparseLU<Matrix, Eigen::COLAMDOrdering<int>> lu;
  Eigen::VectorXd right;
};

ImplicitSolver::ImplicitSolver() : factors_(std::make_unique<Factors>()) {}
ImplicitSolver::~ImplicitSolver() = default;

void ImplicitSolver::factorize(const RateMatrix& R, double scale) {
  auto& [matrix, entries, lu, right] = *factors_;
  const auto n = static_cast<int>(R.size());
  entries.clear();
  for (int j = 0; j < n; ++j) {
    entries.emplace_back(j, j, 1.0);
    for (std::ptrdiff_t k = R.begin[j]; k < R.begin[j + 1]; ++k) {
      if (!std::isfinite(R.value[k])) throw std::domain_error("the matrix of the implicit step is not finite");
      entries.emplace_back(j, R.column[k], -scale * R.value[k]);
    }
  }
  matrix.resize(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  lu.compute(matrix);
  if (lu.info() != Eigen::Success) throw std::domain_error("the matrix of the implicit step is singular");
}

void ImplicitSolver::solve(std::span<double> g) {
  const Eigen::Map<Eigen::VectorXd> values(g.data(), std::ssize(g));
  factors_->right = factors_->lu.solve(values);
  std::copy(factors_->right.begin(), factors_->right.end(), g.begin());
}

}  // namespace acstudy
