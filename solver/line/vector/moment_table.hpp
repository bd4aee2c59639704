#pragma once

/// @file
/// Moments of any kernel as polynomials on pieces, for sums over several particles at a time.

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace acstudy {

/// A moment within a distance z, in units of the horizon, to a few units in the last place. On each piece it is a
/// polynomial in z - origin, on the first one times a power of z.
struct MomentTable {
  std::vector<double> bounds;         ///< [pieces + 1], from 0 to 1
  std::vector<double> origin;         ///< [pieces]
  std::vector<std::ptrdiff_t> terms;  ///< [pieces], coefficients of each
  std::vector<double> coefficient;    ///< [pieces][most_terms], lowest first
  int power = 0;                      ///< of z on the first piece; less than 0 where it is no polynomial at all
  static constexpr int most_terms = 16;

  /// For files that are compiled for several instruction sets, in which no function of std::vector may be.
  struct View {
    std::ptrdiff_t pieces;
    const double *bounds, *origin, *coefficient;
    const std::ptrdiff_t* terms;
    int power;
  };
  View view() const {
    return {std::ssize(origin), bounds.data(), origin.data(), coefficient.data(), terms.data(), power};
  }

  /// As the sweeps have it.  @pre the piece is a polynomial
  double at(std::size_t piece, double z) const;
};

/// @param moment  a kernel's first moment or mass within z, 0 < z <= 1, positive, to round-off
/// @param breaks  where it is not smooth, besides 0 and 1; it may go like any power of z at 0
MomentTable moment_table(const std::function<double(double)>& moment, std::span<const double> breaks);

}  // namespace acstudy
