#include "solver/time/implicit.hpp"

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "solver/time/band_factors.hpp"

namespace acstudy {

namespace {

/// Any matrix at all.
class SparseFactors {
 public:
  void factorize(const RateMatrix& R, double scale) {
    const auto n = static_cast<int>(R.size());
    entries_.clear();
    for (int j = 0; j < n; ++j) {
      entries_.emplace_back(j, j, 1.0);
      for (std::ptrdiff_t k = R.begin[j]; k < R.begin[j + 1]; ++k) {
        if (!std::isfinite(R.value[k])) throw std::domain_error("the matrix of the implicit step is not finite");
        entries_.emplace_back(j, R.column[k], -scale * R.value[k]);
      }
    }
    matrix_.resize(n, n);
    matrix_.setFromTriplets(entries_.begin(), entries_.end());
    lu_.compute(matrix_);
    if (lu_.info() != Eigen::Success) throw std::domain_error("the matrix of the implicit step is singular");
  }
  void solve(std::span<double> g) {
    const Eigen::Map<Eigen::VectorXd> values(g.data(), std::ssize(g));
    right_ = lu_.solve(values);
    std::copy(right_.begin(), right_.end(), g.begin());
  }

 private:
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
  Matrix matrix_;
  std::vector<Eigen::Triplet<double, int>> entries_;
  Eigen::SparseLU<Matrix, Eigen::COLAMDOrdering<int>> lu_;
  Eigen::VectorXd right_;
};

/// The same rows as a list of entries.
RateMatrix entries_of(const BandedMatrix& R, std::span<const double> own) {
  const std::ptrdiff_t n = std::ssize(own);
  RateMatrix list;
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    const BandedMatrix::Block& block = R.blocks[j / R.lanes];
    list.add(j, n, own[j]);
    for (std::ptrdiff_t k = 0; k < block.width; ++k) {
      const double value = R.value[block.begin + k * R.lanes + j % R.lanes];
      if (value != 0.0) list.add(j + block.first + k, n, value);
    }
    list.end_row();
  }
  return list;
}

}  // namespace

struct ImplicitSolver::Factors {
  PeriodicBand band;
  TridiagonalFactors tridiagonal;
  BorderedFactors bordered;
  FoldedFactors folded;
  std::unique_ptr<SparseFactors> sparse;  ///< large, and hardly ever needed
  enum class Kind { tridiagonal, bordered, folded, sparse } kind;

  template <class Do>
  void with_chosen(Do&& what) {
    switch (kind) {
      case Kind::tridiagonal:
        return what(tridiagonal);
      case Kind::bordered:
        return what(bordered);
      case Kind::folded:
        return what(folded);
      case Kind::sparse:
        return what(*sparse);
    }
  }
  void factorize_sparse(const RateMatrix& R, double scale) {
    kind = Kind::sparse;
    if (!sparse) sparse = std::make_unique<SparseFactors>();
    sparse->factorize(R, scale);
  }
};

ImplicitSolver::ImplicitSolver(Method method) : method_(method), factors_(std::make_unique<Factors>()) {}
ImplicitSolver::~ImplicitSolver() = default;
ImplicitSolver::ImplicitSolver(ImplicitSolver&&) noexcept = default;

void ImplicitSolver::factorize(const RateMatrix& R, double scale) {
  if (method_ != Method::sparse && factors_->band.assemble(R, scale)) {
    factorize_band();
  } else {
    factors_->factorize_sparse(R, scale);
  }
}

void ImplicitSolver::factorize(const BandedMatrix& R, std::span<const double> own, double scale) {
  if (method_ != Method::sparse && factors_->band.assemble(R, own, scale)) {
    factorize_band();
  } else {
    factors_->factorize_sparse(entries_of(R, own), scale);
  }
}

void ImplicitSolver::factorize_band() {
  Factors& f = *factors_;
  if (method_ == Method::pivoted || !f.band.dominant()) {
    f.kind = Factors::Kind::folded;
    f.folded.factorize(f.band);
  } else if (f.band.widest() <= 1) {
    f.kind = Factors::Kind::tridiagonal;
    f.tridiagonal.factorize(f.band);
  } else {
    f.kind = Factors::Kind::bordered;
    f.bordered.factorize(f.band);
  }
}

void ImplicitSolver::solve(std::span<double> g) {
  factors_->with_chosen([&](auto& factors) { factors.solve(g); });
}

}  // namespace acstudy
