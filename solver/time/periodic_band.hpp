#pragma once

/// @file
/// The matrix of an implicit step on a periodic line, as the band with corners that it is.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/rate_matrix.hpp"

namespace acstudy {

/// I - scale R, whose row j has entries from column j - left(j) to j + right(j), modulo N, each row as wide as it is.
class PeriodicBand {
 public:
  /// Looks at the rows of R.
  /// @return false if a window may reach once around: then this is no band, or there are fewer than three rows
  /// @throws std::domain_error if an entry is not finite
  bool assemble(const RateMatrix& R, double scale);
  /// The same for rows whose diagonal entries are given beside them.
  /// @param R    zero on the diagonal, of at most eight lanes; it is read as long as this is
  /// @param own  shape [N]
  bool assemble(const BandedMatrix& R, std::span<const double> own, double scale);

  std::ptrdiff_t size() const { return std::ssize(left_); }
  std::ptrdiff_t left(std::ptrdiff_t j) const { return left_[j]; }
  std::ptrdiff_t right(std::ptrdiff_t j) const { return right_[j]; }
  /// The largest left() or right().
  std::ptrdiff_t widest() const { return widest_; }
  double diagonal(std::ptrdiff_t j) const { return diagonal_[j]; }
  /// The entry of row j in column j + k, k != 0.
  double beside(std::ptrdiff_t j, std::ptrdiff_t k) const { return minus_scale_ * values_[center_[j] + k * stride_]; }
  /// Any entry.
  double at(std::ptrdiff_t j, std::ptrdiff_t k) const { return k == 0 ? diagonal(j) : beside(j, k); }

  /// Another number each time that some row has become wider or narrower.
  std::int64_t shape() const { return shape_; }
  /// Rows, or else columns, have diagonal entries above the sum of the sizes of all others: elimination needs no
  /// pivoting then, entries grow by a factor of two at most, and no pivot is zero.
  bool dominant() const { return row_dominant_ || column_dominant(); }

 private:
  /// What has been seen of the rows.
  struct Seen {
    bool changed, dominant = true;
    double finite = 0.0;  ///< NaN if something is not
    std::ptrdiff_t widest = 0;
  };
  Seen start(std::ptrdiff_t count, double scale);
  /// Takes row j, whose entries beside the diagonal have these sizes in all, but for the scale.
  void set_row(Seen& seen, std::ptrdiff_t j, std::ptrdiff_t left, std::ptrdiff_t right, double diagonal, double sizes) {
    seen.dominant &= diagonal > -minus_scale_ * sizes;
    seen.finite += 0.0 * (diagonal + sizes);
    seen.changed |= left_[j] != left || right_[j] != right;
    seen.widest = std::max({seen.widest, left, right});
    left_[j] = left;
    right_[j] = right;
    diagonal_[j] = diagonal;
  }
  /// @return what assemble() does
  bool close(const Seen& seen);
  bool column_dominant() const;

  std::vector<std::ptrdiff_t> left_, right_;
  std::vector<std::ptrdiff_t> center_;  ///< where the diagonal of a row is, or would be, among the values
  std::vector<double> diagonal_;
  const double* values_ = nullptr;  ///< of R
  std::vector<double> own_values_;  ///< where these are not read where they are
  std::ptrdiff_t stride_ = 1;
  double minus_scale_ = 0.0;
  std::ptrdiff_t widest_ = 0;
  std::int64_t shape_ = 0;
  bool row_dominant_ = false;
};

}  // namespace acstudy
