#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/clones.hpp"
#include "solver/time/band_factors.hpp"
#include "solver/time/pivots.hpp"

namespace acstudy {

namespace {

/// Entries are taken four at a time, in all rows those of the same four columns: what has just been written is read
/// again as it was written. What is beyond the ends of a row is zero.
constexpr std::ptrdiff_t unit = 4;
constexpr std::ptrdiff_t whole(std::ptrdiff_t count) { return (count + unit - 1) / unit * unit; }
constexpr std::ptrdiff_t first_of_unit(std::ptrdiff_t column) { return column / unit * unit; }

/// a -= factor b in columns begin .. end - 1, whole units.
inline void subtract(double* __restrict a, double factor, const double* __restrict b, std::ptrdiff_t begin,
                     std::ptrdiff_t end) {
  for (std::ptrdiff_t k = begin; k < end; k += unit) {
    for (std::ptrdiff_t t = 0; t < unit; ++t) a[k + t] -= factor * b[k + t];
  }
}

}  // namespace

void BorderedFactors::cut(const PeriodicBand& A) {
  // Before the row that reaches least across, to the left, or is reached least by the one before it.
  std::ptrdiff_t least = size_;
  for (std::ptrdiff_t j = 0; j < size_; ++j) {
    const std::ptrdiff_t across = std::max(A.left(j), A.right(j > 0 ? j - 1 : size_ - 1));
    if (across >= least) continue;
    least = across;
    start_ = j;
  }
  // Others may reach further: rows after the cut to the left, and rows before it to the right.
  border_ = 1;
  for (std::ptrdiff_t k = 0; k < A.widest(); ++k) {
    const std::ptrdiff_t before = start_ - 1 - k;
    border_ = std::max(border_, A.left(row_of(k)) - k);
    if (A.right(before < 0 ? before + size_ : before) > k) border_ = std::max(border_, k + 1);
  }
  stride_ = whole(border_);
  inner_ = size_ - border_;
}

void BorderedFactors::lay_out(const PeriodicBand& A) {
  shape_ = A.shape();
  size_ = A.size();
  cut(A);
  const auto inner = static_cast<std::size_t>(inner_);
  for (auto* columns : {&lower_, &upper_, &origin_, &origin_above_}) columns->resize(inner);
  for (auto* flags : {&has_right_, &has_below_}) flags->assign(inner, 0);
  inverse_.resize(inner);
  std::ptrdiff_t begin = 0, begin_above = 0, filled = -1;
  for (std::ptrdiff_t i = 0; i < inner_; ++i) {
    const std::ptrdiff_t j = row_of(i);
    lower_[i] = std::max<std::ptrdiff_t>(i - A.left(j), 0);
    upper_[i] = std::min(i + A.right(j), inner_ - 1);
    if (lower_[i] < i) upper_[i] = std::max(upper_[i], filled);
    filled = std::max(filled, upper_[i]);
    const std::ptrdiff_t end = whole(upper_[i] + 1);
    origin_[i] = begin - first_of_unit(lower_[i]);
    begin = origin_[i] + end;
    origin_above_[i] = begin_above - first_of_unit(i + 1);
    begin_above = std::max(origin_above_[i] + end, begin_above);
  }
  for (auto* entries : {&entry_, &factor_}) entries->resize(static_cast<std::size_t>(begin));
  has_clean_ends_ = false;
  above_.resize(static_cast<std::size_t>(begin_above));
  const auto room = static_cast<std::size_t>(stride_);
  for (auto* columns : {&right_, &below_}) columns->resize(inner * room);
  corner_.resize(static_cast<std::size_t>(border_) * room);
  pivots_.resize(static_cast<std::size_t>(border_));
  y_.resize(static_cast<std::size_t>(size_));
}

void BorderedFactors::fill_row(const PeriodicBand& A, std::ptrdiff_t i) {
  const std::ptrdiff_t j = row_of(i), left = A.left(j), last = std::min(A.right(j), inner_ - 1 - i);
  double* const row = entry_.data() + origin_[i] + i;
  const std::ptrdiff_t first = lower_[i] - i;
  for (std::ptrdiff_t k = first; k <= last; ++k) row[k] = A.beside(j, k);
  row[0] = A.diagonal(j);
  if (!has_clean_ends_) {
    std::fill(row + first_of_unit(lower_[i]) - i, row + first, 0.0);
    std::fill(row + upper_[i] - i + 1, row + whole(upper_[i] + 1) - i, 0.0);
  }
  for (std::ptrdiff_t k = last + 1; k <= upper_[i] - i; ++k) row[k] = 0.0;
  // Before the first column, and after the last one, stand those of the border.
  double* const right = right_.data() + i * stride_;
  has_right_[i] = left > i || A.right(j) > last;
  if (!has_right_[i]) return;
  std::fill_n(right, stride_, 0.0);
  for (std::ptrdiff_t k = -left; k < first; ++k) right[border_ + i + k] = A.beside(j, k);
  for (std::ptrdiff_t k = last + 1; k <= A.right(j); ++k) right[i + k - inner_] = A.beside(j, k);
}

namespace {

/// What the elimination of rows works on; see BorderedFactors.
struct Rows {
  const std::ptrdiff_t *lower, *upper, *origin, *origin_above;
  double *entry, *factor, *above, *inverse, *right;
  char* has_right;
  std::ptrdiff_t stride;
};

/// Eliminates what rows begin .. end - 1 have before their diagonals.
ACSTUDY_VECTOR_CLONES void eliminate_rows(const Rows rows, std::ptrdiff_t begin, std::ptrdiff_t end) {
  for (std::ptrdiff_t i = begin; i < end; ++i) {
    double* const row = rows.entry + rows.origin[i];
    double* const factors = rows.factor + rows.origin[i];
    double* const right = rows.right + i * rows.stride;
    for (std::ptrdiff_t k = rows.lower[i]; k < i; ++k) {
      const double l = factors[k] = row[k] * rows.inverse[k];
      if (rows.upper[k] > k) {
        subtract(row, l, rows.above + rows.origin_above[k], first_of_unit(k + 1), rows.upper[k] + 1);
      }
      if (!rows.has_right[k]) continue;
      if (!rows.has_right[i]) {
        for (std::ptrdiff_t b = 0; b < rows.stride; ++b) right[b] = 0.0;
        rows.has_right[i] = 1;
      }
      subtract(right, l, rows.right + k * rows.stride, 0, rows.stride);
    }
    const double inverse = rows.inverse[i] = 1.0 / row[i];
    double* const above = rows.above + rows.origin_above[i];
    const std::ptrdiff_t first = first_of_unit(i + 1);
    for (std::ptrdiff_t c = first; c <= rows.upper[i]; c += unit) {
      for (std::ptrdiff_t t = 0; t < unit; ++t) above[c + t] = c + t > i ? row[c + t] : 0.0;
    }
    if (!rows.has_right[i]) continue;
    double largest = 0.0;
    for (std::ptrdiff_t b = 0; b < rows.stride; ++b) {
      const double size = std::abs(right[b] * inverse);
      largest = size > largest ? size : largest;
    }
    rows.has_right[i] = largest > negligible;
  }
}

}  // namespace

void BorderedFactors::eliminate(const PeriodicBand& A) {
  const Rows rows{lower_.data(), upper_.data(),   origin_.data(), origin_above_.data(), entry_.data(), factor_.data(),
                  above_.data(), inverse_.data(), right_.data(),  has_right_.data(),    stride_};
  constexpr std::ptrdiff_t at_once = 128;  // so that they are in the cache
  for (std::ptrdiff_t begin = 0; begin < inner_; begin += at_once) {
    const std::ptrdiff_t end = std::min(begin + at_once, inner_);
    for (std::ptrdiff_t i = begin; i < end; ++i) fill_row(A, i);
    eliminate_rows(rows, begin, end);
  }
  // What is beyond the ends of a row stays zero, unless something that is not finite has spread.
  has_clean_ends_ = all_finite(inverse_);
  if (!has_clean_ends_) refuse_singular();
}

void BorderedFactors::fill_border(const PeriodicBand& A) {
  std::fill(corner_.begin(), corner_.end(), 0.0);
  std::fill(has_below_.begin(), has_below_.end(), 0);
  first_columns_ = -1;
  last_columns_ = inner_;
  for (std::ptrdiff_t q = 0; q < border_; ++q) {
    const std::ptrdiff_t j = row_of(inner_ + q);
    first_columns_ = std::max(first_columns_, q + A.right(j) - border_);
    last_columns_ = std::min(last_columns_, inner_ + q - A.left(j));
  }
  const auto at_column = [&](std::ptrdiff_t column) { return below_.begin() + column * stride_; };
  std::fill(below_.begin(), at_column(first_columns_ + 1), 0.0);
  std::fill(at_column(last_columns_), below_.end(), 0.0);
  for (std::ptrdiff_t q = 0; q < border_; ++q) {
    const std::ptrdiff_t j = row_of(inner_ + q);
    for (std::ptrdiff_t k = -A.left(j); k <= A.right(j); ++k) {
      const std::ptrdiff_t column = inner_ + q + k;
      if (column < inner_) {
        below_[column * stride_ + q] = A.beside(j, k);
      } else if (column < size_) {
        corner_[q * stride_ + column - inner_] = A.at(j, k);
      } else {
        below_[(column - size_) * stride_ + q] = A.beside(j, k);
      }
    }
  }
}

void BorderedFactors::eliminate_border() {
  std::ptrdiff_t touched = first_columns_;
  for (std::ptrdiff_t k = 0; k < inner_; ++k) {
    if (k > touched && k < last_columns_) continue;
    double* const below = below_.data() + k * stride_;
    for (std::ptrdiff_t q = 0; q < border_; ++q) below[q] *= inverse_[k];
    if (std::all_of(below, below + border_, [](double l) { return std::abs(l) <= negligible; })) continue;
    has_below_[k] = 1;
    for (; touched < upper_[k]; ++touched) {
      if (touched + 1 < last_columns_) std::fill_n(below_.begin() + (touched + 1) * stride_, stride_, 0.0);
    }
    const double* const above = above_.data() + origin_above_[k];
    for (std::ptrdiff_t c = k + 1; c <= upper_[k]; ++c) {
      subtract(below_.data() + c * stride_, above[c], below, 0, stride_);
    }
    if (!has_right_[k]) continue;
    for (std::ptrdiff_t q = 0; q < border_; ++q) {
      subtract(corner_.data() + q * stride_, below[q], right_.data() + k * stride_, 0, stride_);
    }
  }
  for (std::ptrdiff_t k = 0; k < border_; ++k) {
    std::ptrdiff_t pivot = k;
    const auto at = [&](std::ptrdiff_t q, std::ptrdiff_t c) -> double& { return corner_[q * stride_ + c]; };
    for (std::ptrdiff_t q = k + 1; q < border_; ++q) {
      if (std::abs(at(q, k)) > std::abs(at(pivot, k))) pivot = q;
    }
    pivots_[k] = pivot;
    if (pivot != k) std::swap_ranges(&at(k, k), &at(k, 0) + border_, &at(pivot, k));
    const double inverse = inverse_of(at(k, k));
    for (std::ptrdiff_t q = k + 1; q < border_; ++q) {
      const double l = at(q, k) *= inverse;
      for (std::ptrdiff_t c = k + 1; c < border_; ++c) at(q, c) -= l * at(k, c);
    }
  }
}

void BorderedFactors::factorize(const PeriodicBand& A) {
  if (shape_ != A.shape()) lay_out(A);
  eliminate(A);
  fill_border(A);
  eliminate_border();
}

void BorderedFactors::solve(std::span<double> g) {
  double* const y = y_.data();
  const auto cut_at = g.begin() + start_;
  std::rotate_copy(g.begin(), cut_at, g.end(), y_.begin());
  double* const at_border = y + inner_;
  for (std::ptrdiff_t i = 0; i < inner_; ++i) {
    const double* const row = factor_.data() + origin_[i];
    double sum = y[i];
    for (std::ptrdiff_t k = lower_[i]; k < i; ++k) sum -= row[k] * y[k];
    y[i] = sum;
    if (!has_below_[i]) continue;
    for (std::ptrdiff_t q = 0; q < border_; ++q) at_border[q] -= below_[i * stride_ + q] * sum;
  }
  const auto corner = [&](std::ptrdiff_t q, std::ptrdiff_t c) { return corner_[q * stride_ + c]; };
  for (std::ptrdiff_t k = 0; k < border_; ++k) {
    std::swap(at_border[k], at_border[pivots_[k]]);
    for (std::ptrdiff_t q = k + 1; q < border_; ++q) at_border[q] -= corner(q, k) * at_border[k];
  }
  for (std::ptrdiff_t k = border_ - 1; k >= 0; --k) {
    for (std::ptrdiff_t c = k + 1; c < border_; ++c) at_border[k] -= corner(k, c) * at_border[c];
    at_border[k] /= corner(k, k);
  }
  for (std::ptrdiff_t i = inner_ - 1; i >= 0; --i) {
    const double* const above = above_.data() + origin_above_[i];
    double sum = y[i];
    if (has_right_[i]) {
      for (std::ptrdiff_t q = 0; q < border_; ++q) sum -= right_[i * stride_ + q] * at_border[q];
    }
    // The newest one last: it alone is waited for.
    for (std::ptrdiff_t c = upper_[i]; c > i; --c) sum -= above[c] * y[c];
    y[i] = sum * inverse_[i];
  }
  std::rotate_copy(y_.begin(), y_.end() - start_, y_.end(), g.begin());
}

}  // namespace acstudy
