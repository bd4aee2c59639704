#pragma once

/// @file
/// Cell moments of the kernels as polynomials in the distance, which is what makes sums over many cells short.

#include "solver/vector/kernels.hpp"
#include "solver/vector/lanes.hpp"

namespace acstudy::far {
inline namespace ACSTUDY_ISA {

// A cell moment M, up to a factor, of a cell whose outer edge is at z and whose width is g:
//
//   M::breakpoint           end of the piece `inside`, or 1
//   M::degree               of its primitive
//   M::primitive<piece>(k)  coefficient of z^k in F, where the moment is F(z) - F(z - g)
//   M::of<piece>(cell)      the moment, without the loss of digits of that difference

/// The first moment of eta(z) = 1/z.
struct InverseFirstMoment {
  static constexpr double breakpoint = 1.0;
  static constexpr int degree = 1;
  template <Piece>
  static constexpr double primitive(int k) {
    return k == 1 ? 1.0 : 0.0;
  }
  template <Piece piece>
  ACSTUDY_ALWAYS_INLINE static inline Lanes of(const CellLanes& cell) {
    return InverseLanes{}.first_moment<piece>(cell);
  }
};

/// The first moment of the derivative of the cubic B-spline.
struct SplineFirstMoment {
  static constexpr double breakpoint = 0.5;
  static constexpr int degree = 4;
  template <Piece piece>
  static constexpr double primitive(int k) {
    constexpr double inside[] = {0.0, 0.0, 0.0, 8.0, -9.0}, outside[] = {0.0, 0.0, 6.0, -8.0, 3.0};
    return piece == Piece::inside ? inside[k] : outside[k];
  }
  template <Piece piece>
  ACSTUDY_ALWAYS_INLINE static inline Lanes of(const CellLanes& cell) {
    return CubicSplineLanes{}.first_moment<piece>(cell);
  }
};

/// The mass of the derivative of the cubic B-spline.
struct SplineMass {
  static constexpr double breakpoint = 0.5;
  static constexpr int degree = 3;
  template <Piece piece>
  static constexpr double primitive(int k) {
    constexpr double inside[] = {0.0, 0.0, 1.0, -1.0}, outside[] = {0.0, 1.0, -1.0, 1.0 / 3.0};
    return piece == Piece::inside ? inside[k] : outside[k];
  }
  template <Piece piece>
  ACSTUDY_ALWAYS_INLINE static inline Lanes of(const CellLanes& cell) {
    return CubicSplineLanes{}.mass<piece>(cell);
  }
};

/// coefficient[n], n < degree: the moment of a cell of width g as a polynomial in z.
template <class M, Piece piece>
ACSTUDY_ALWAYS_INLINE inline void moment_coefficients(Lanes g, Lanes* coefficient) {
  // F(z) - F(z - g) = - sum_n z^n sum_{k > n} binomial(k, n) f_k (-g)^(k - n)
#pragma GCC unroll 4
  for (int n = 0; n < M::degree; ++n) {
    Lanes sum = {};
    double binomial = 1.0;
    Lanes power = -g;
    for (int k = n + 1; k <= M::degree; ++k) {
      binomial *= static_cast<double>(k) / (k - n);
      sum -= binomial * M::template primitive<piece>(k) * power;
      power *= -g;
    }
    coefficient[n] = sum;
  }
}

}  // namespace ACSTUDY_ISA
}  // namespace acstudy::far
