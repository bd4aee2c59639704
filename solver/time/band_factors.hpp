#pragma once

/// @file
/// Direct solvers for periodic bands.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/time/periodic_band.hpp"

namespace acstudy {

/// Of rows with no more than their two neighbors: one recurrence over all rows but the last, which closes it.
/// Without pivoting.
class TridiagonalFactors {
 public:
  /// @pre A.widest() <= 1 and at least three rows
  /// @throws std::domain_error at a pivot that is zero or not finite
  void factorize(const PeriodicBand& A);
  /// g <- the solution.
  void solve(std::span<double> g) const;

 private:
  std::vector<double> lower_, inverse_, upper_;  ///< l_i, 1/u_i and what the row above the diagonal has, over u_i
  std::vector<double> right_, below_;            ///< the last column over u_i, and the last row
  double last_inverse_ = 0.0;
};

/// Elimination in the order of the rows, without pivoting. The circle is cut where the windows are narrowest; the last
/// unknowns before the cut, as many as reach across it, form a border of full rows and columns. Rows keep their widths:
/// one-sided rows have one-sided factors, and the border's influence is dropped where it has decayed to nothing.
class BorderedFactors {
 public:
  /// @pre A.dominant(), 2 A.widest() < N
  /// @throws std::domain_error at a pivot that is zero or not finite
  void factorize(const PeriodicBand& A);
  void solve(std::span<double> g);

 private:
  void cut(const PeriodicBand& A);
  void lay_out(const PeriodicBand& A);
  void eliminate(const PeriodicBand& A);
  void fill_row(const PeriodicBand& A, std::ptrdiff_t i);
  void fill_border(const PeriodicBand& A);
  void eliminate_border();

  std::ptrdiff_t row_of(std::ptrdiff_t i) const { return i + start_ < size_ ? i + start_ : i + start_ - size_; }

  std::int64_t shape_ = 0;                  ///< of the band that this is laid out for
  std::ptrdiff_t size_ = 0, start_ = 0;     ///< rows, and the one after the cut
  std::ptrdiff_t border_ = 0, stride_ = 0;  ///< unknowns of the border, and room for them
  std::ptrdiff_t inner_ = 0;                ///< all others
  // Of inner row i: its first column, its last one with what elimination fills in, where its column 0 is or would be
  // among the entries and the factors of rows above it, and what it has in the columns of the border.
  std::vector<std::ptrdiff_t> lower_, upper_, origin_;
  std::vector<double> entry_, factor_;
  // The same of its part above the diagonal, zero elsewhere.
  std::vector<std::ptrdiff_t> origin_above_;
  std::vector<double> above_;
  std::vector<double> inverse_, right_;
  std::vector<double> below_;  ///< the border's rows, column after column
  std::vector<char> has_right_, has_below_;
  bool has_clean_ends_ = false;                          ///< the entries beyond the ends of rows are zero
  std::ptrdiff_t first_columns_ = 0, last_columns_ = 0;  ///< where the border's rows have entries at either end
  std::vector<double> corner_;                           ///< border_ rows of stride_
  std::vector<std::ptrdiff_t> pivots_;
  std::vector<double> y_;
};

/// Elimination with partial pivoting. The circle is folded, so that row i from one end comes beside row i from the
/// other: a band of twice the width without corners.
class FoldedFactors {
 public:
  /// @pre 2 A.widest() < N
  /// @throws std::domain_error at a pivot that is zero or not finite
  void factorize(const PeriodicBand& A);
  void solve(std::span<double> g);

 private:
  /// Where row i stands in the fold.
  std::ptrdiff_t place_of(std::ptrdiff_t i) const { return 2 * i < size_ ? 2 * i : 2 * (size_ - i) - 1; }

  std::ptrdiff_t size_ = 0, reach_ = 0, stride_ = 0;  ///< rows, half the width of the band, entries of a column
  std::vector<double> column_;                        ///< of the band, as LAPACK's gbtrf keeps it
  std::vector<std::ptrdiff_t> pivots_;
  std::vector<double> y_;
};

}  // namespace acstudy
