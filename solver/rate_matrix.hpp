#pragma once

/// @file
/// The matrix of a scheme's rates, as implicit integrators and studies of its steps need it.

#include <cstddef>
#include <vector>

namespace acstudy {

/// R with rate_j(u) = sum_i R_ji u_i, row after row. A column may stand twice in a row, where few particles see one
/// neighbor on both sides; its entries add up.
struct RateMatrix {
  std::vector<std::ptrdiff_t> begin = {0};  ///< row j has the entries begin[j] .. begin[j+1] - 1, shape [N + 1]
  std::vector<int> column;                  ///< 0 .. N-1
  std::vector<double> value;

  std::size_t size() const { return begin.size() - 1; }
  void clear() {
    begin.assign(1, 0);
    column.clear();
    value.clear();
  }
  /// Adds an entry to the row that is being written; any `neighbor` from -N to 2N - 1 is meant modulo N.
  void add(std::ptrdiff_t neighbor, std::ptrdiff_t count, double entry) {
    column.push_back(static_cast<int>(neighbor < 0        ? neighbor + count
                                      : neighbor >= count ? neighbor - count
                                                          : neighbor));
    value.push_back(entry);
  }
  void end_row() { begin.push_back(std::ssize(value)); }
};

/// A matrix of rates for several rows at a time: blocks of as many as there are lanes, diagonal after diagonal, so that
/// everything is read with unit stride.
struct BandedMatrix {
  struct Block {
    std::ptrdiff_t begin;  ///< of its values
    std::ptrdiff_t first;  ///< lowest offset from a row to a column
    std::ptrdiff_t width;  ///< number of diagonals
  };
  std::ptrdiff_t lanes = 1;  ///< rows of a block
  std::vector<Block> blocks;
  std::vector<double> value;  ///< [diagonal][lane] of each block, zero where a row has nothing
  std::ptrdiff_t reach = 0;   ///< largest offset from a row to a column, padding included

  /// Zero rows, to be written to.
  BandedMatrix() = default;
  /// @param lanes  rows of a block
  BandedMatrix(const RateMatrix& R, int lanes);
};

}  // namespace acstudy
