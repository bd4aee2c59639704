#pragma once

/// @file
/// Sums of polynomials of low degree, whose origin moves along.

#include "solver/line/vector/lanes.hpp"

namespace acstudy::far {
inline namespace ACSTUDY_ISA {

/// Replaces the coefficients of a polynomial in u by those in v, where u = v + h.
template <int terms, class Number>
ACSTUDY_ALWAYS_INLINE inline void move_origin(Lanes* coefficient, Number h) {
#pragma GCC unroll 4
  for (int i = 0; i + 1 < terms; ++i) {
#pragma GCC unroll 4
    for (int n = terms - 2; n >= i; --n) coefficient[n] += h * coefficient[n + 1];
  }
}

/// Sums of polynomials with `terms` coefficients, one for each of `width` columns, a multiple of the lanes.
template <int terms, int width>
struct PolynomialSums {
  double coefficient[terms * width + 1];

  ACSTUDY_ALWAYS_INLINE inline void clear() {
    for (int k = 0; k < terms * width; ++k) coefficient[k] = 0.0;
  }
  ACSTUDY_NEVER_INLINE void move(double h) {
    for (int c = 0; c < width; c += lane_count) {
      Lanes column[terms + 1];
      read(c, column);
      move_origin<terms>(column, h);
      for (int n = 0; n < terms; ++n) store(coefficient + n * width + c, column[n]);
    }
  }
  /// Adds sign times other, whose argument is h more than that of this one.
  ACSTUDY_NEVER_INLINE void add(const PolynomialSums& other, double h, double sign) {
    for (int c = 0; c < width; c += lane_count) {
      Lanes column[terms + 1];
      other.read(c, column);
      move_origin<terms>(column, h);
      for (int n = 0; n < terms; ++n) {
        double* const sum = coefficient + n * width + c;
        store(sum, load(sum) + sign * column[n]);
      }
    }
  }

 private:
  ACSTUDY_ALWAYS_INLINE inline void read(int c, Lanes* column) const {
    for (int n = 0; n < terms; ++n) column[n] = load(coefficient + n * width + c);
  }
};

}  // namespace ACSTUDY_ISA
}  // namespace acstudy::far
