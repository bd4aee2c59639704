#pragma once

/// @file
/// Moments of any kernel as polynomials on pieces, for sums over several particles at a time.

#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace acstudy {

/// A moment within a distance z, in units of the horizon, to a few units in the last place. On each piece it is a
/// polynomial in z - origin, or in z^2 - origin, on the first one times a whole or
/// half power of z.
struct MomentTable {
  static constexpr int most_terms = 24;
  struct Piece {
    double begin, end;  ///< of the first one 0, of the last one 1
    double origin;
    std::ptrdiff_t terms;            ///< coefficients in use
    double coefficient[most_terms];  ///< lowest first
  };
  std::vector<Piece> pieces;
  bool squared = false;  ///< in z^2
  int power = 0;         ///< of z on the first piece; less than 0 where it is no polynomial at all
  bool root = false;     ///< there the square root of z is a factor, too

  /// For files that are compiled for several instruction sets, in which no function of std::vector may be.
  struct View {
    const Piece* pieces;
    std::ptrdiff_t count;
    bool squared;
    int power;
    bool root;
  };
  View view() const { return {pieces.data(), std::ssize(pieces), squared, power, root}; }

  /// What the polynomial of the first piece is multiplied with.
  template <class Real>
  Real factor(Real z) const {
    return std::pow(z, power) * (root ? std::sqrt(z) : Real(1));
  }
  /// As the sweeps have it.  @pre the piece is a polynomial
  double at(const Piece& piece, double z) const;
};

/// @param moment  a kernel's first moment or mass within z, 0 < z <= 1, positive, to round-off
/// @param breaks  where it is not smooth, besides 0 and 1; it may go like any power of z at 0
MomentTable moment_table(const std::function<double(double)>& moment, std::span<const double> breaks);

}  // namespace acstudy
