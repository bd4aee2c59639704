#include "solver/time/band_factors.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/time/pivots.hpp"

namespace acstudy {

namespace {

double kept(double value) { return std::abs(value) < negligible ? 0.0 : value; }

}  // namespace

void TridiagonalFactors::factorize(const PeriodicBand& A) {
  const std::ptrdiff_t last = A.size() - 1;
  for (auto* factor : {&lower_, &inverse_, &upper_, &right_, &below_}) factor->resize(static_cast<std::size_t>(last));
  const auto before = [&](std::ptrdiff_t i) { return A.left(i) > 0 ? A.beside(i, -1) : 0.0; };
  const auto after = [&](std::ptrdiff_t i) { return A.right(i) > 0 ? A.beside(i, 1) : 0.0; };
  double right = before(0), below = after(last), corner = A.diagonal(last);
  double inverse_before = 0.0, upper_before = 0.0, scaled_below_before = 0.0;
  for (std::ptrdiff_t i = 0; i < last; ++i) {
    const double a = i > 0 ? before(i) : 0.0, b = i + 1 < last ? after(i) : 0.0;
    // Where two neighbors do not both see each other, as in Model I, a pivot need not wait for the one before.
    const double product = a * upper_before;
    const double inverse = 1.0 / (product == 0.0 ? A.diagonal(i) : A.diagonal(i) - product * inverse_before);
    const double l = a * inverse_before;
    if (i > 0) right = kept(-l * right);
    if (i > 0) below = kept(-scaled_below_before * upper_before);
    if (i + 1 == last) {
      right += after(i);
      below += before(last);
    }
    lower_[i] = l;
    inverse_[i] = inverse;
    upper_[i] = b * inverse;
    right_[i] = right * inverse;
    below_[i] = below * inverse;
    corner -= below_[i] * right;
    inverse_before = inverse;
    upper_before = b;
    scaled_below_before = below_[i];
  }
  last_inverse_ = inverse_of(corner);
  if (!all_finite(inverse_)) refuse_singular();
}

void TridiagonalFactors::solve(std::span<double> g) const {
  const std::ptrdiff_t last = std::ssize(g) - 1;
  double y = g[0], closing = g[last] - below_[0] * y;
  for (std::ptrdiff_t i = 1; i < last; ++i) {
    g[i] = y = g[i] - lower_[i] * y;
    closing -= below_[i] * y;
  }
  const double at_last = g[last] = closing * last_inverse_;
  double x = 0.0;
  for (std::ptrdiff_t i = last - 1; i >= 0; --i) g[i] = x = g[i] * inverse_[i] - right_[i] * at_last - upper_[i] * x;
}

void FoldedFactors::factorize(const PeriodicBand& A) {
  size_ = A.size();
  reach_ = std::min(2 * A.widest(), size_ - 1);
  stride_ = 3 * reach_ + 1;
  const auto n = static_cast<std::size_t>(size_);
  column_.assign(n * static_cast<std::size_t>(stride_), 0.0);
  pivots_.resize(n);
  y_.resize(n);
  // The entry of row r in column c is at diagonal + r - c in its column; above it is room for what pivoting fills in.
  const std::ptrdiff_t diagonal = 2 * reach_;
  for (std::ptrdiff_t j = 0; j < size_; ++j) {
    const std::ptrdiff_t r = place_of(j);
    for (std::ptrdiff_t k = -A.left(j); k <= A.right(j); ++k) {
      const std::ptrdiff_t i = j + k, c = place_of(i < 0 ? i + size_ : i >= size_ ? i - size_ : i);
      column_[c * stride_ + diagonal + r - c] = A.at(j, k);
    }
  }
  const auto at = [&](std::ptrdiff_t c) { return column_.data() + c * stride_ + diagonal; };
  std::ptrdiff_t filled = 0;
  for (std::ptrdiff_t k = 0; k < size_; ++k) {
    double* const column = at(k);
    const std::ptrdiff_t below = std::min(reach_, size_ - 1 - k);
    std::ptrdiff_t pivot = 0;
    for (std::ptrdiff_t r = 1; r <= below; ++r) {
      if (std::abs(column[r]) > std::abs(column[pivot])) pivot = r;
    }
    pivots_[k] = pivot;
    filled = std::max(filled, std::min(k + reach_ + pivot, size_ - 1));
    const double inverse = inverse_of(column[pivot]);
    std::swap(column[0], column[pivot]);
    for (std::ptrdiff_t r = 1; r <= below; ++r) column[r] *= inverse;
    for (std::ptrdiff_t c = k + 1; c <= filled; ++c) {
      double* const other = at(c) + k - c;
      std::swap(other[0], other[pivot]);
      const double factor = other[0];
      if (factor == 0.0) continue;
      for (std::ptrdiff_t r = 1; r <= below; ++r) other[r] -= factor * column[r];
    }
  }
}

void FoldedFactors::solve(std::span<double> g) {
  for (std::ptrdiff_t j = 0; j < size_; ++j) y_[place_of(j)] = g[j];
  const auto at = [&](std::ptrdiff_t c) { return column_.data() + c * stride_ + 2 * reach_; };
  for (std::ptrdiff_t k = 0; k < size_; ++k) {
    std::swap(y_[k], y_[k + pivots_[k]]);
    const double y = y_[k];
    const std::ptrdiff_t below = std::min(reach_, size_ - 1 - k);
    for (std::ptrdiff_t r = 1; r <= below; ++r) y_[k + r] -= at(k)[r] * y;
  }
  for (std::ptrdiff_t k = size_ - 1; k >= 0; --k) {
    const double x = y_[k] /= at(k)[0];
    const std::ptrdiff_t above = std::min(2 * reach_, k);
    for (std::ptrdiff_t r = 1; r <= above; ++r) y_[k - r] -= at(k)[-r] * x;
  }
  for (std::ptrdiff_t j = 0; j < size_; ++j) g[j] = y_[place_of(j)];
}

}  // namespace acstudy
