#pragma once

/// @file
/// Moments of the kernels as polynomials in the distance, which is what makes sums over many cells short.

#include "solver/line/vector/kernels.hpp"
#include "solver/line/vector/lanes.hpp"

namespace acstudy::far {
inline namespace ACSTUDY_ISA {

// A moment M within a distance z, up to a factor; that of a cell is the difference at its ends:
//
//   M::breakpoint           end of the piece `inside`, or 1
//   M::within<piece>(z)     the moment
//   M::degree               of it as a polynomial
//   M::primitive<piece>(k)  coefficient of z^k, k >= 1

/// The first moment of eta(z) = 1/z.
struct InverseFirstMoment {
  static constexpr double breakpoint = InverseLanes::breakpoint;
  template <KernelPiece piece>
  ACSTUDY_ALWAYS_INLINE static inline Lanes within(Lanes z) {
    return InverseLanes{}.first_moment<piece>(z);
  }
  static constexpr int degree = 1;
  template <KernelPiece>
  static constexpr double primitive(int k) {
    return k == 1 ? 1.0 : 0.0;
  }
};

/// The first moment of the derivative of the cubic B-spline.
struct SplineFirstMoment {
  static constexpr double breakpoint = CubicSplineLanes::breakpoint;
  template <KernelPiece piece>
  ACSTUDY_ALWAYS_INLINE static inline Lanes within(Lanes z) {
    return CubicSplineLanes{}.first_moment<piece>(z);
  }
  static constexpr int degree = 4;
  template <KernelPiece piece>
  static constexpr double primitive(int k) {
    constexpr double inside[] = {0.0, 0.0, 0.0, 8.0, -9.0}, outside[] = {0.0, 0.0, 6.0, -8.0, 3.0};
    return piece == KernelPiece::inside ? inside[k] : outside[k];
  }
};

/// The mass of the derivative of the cubic B-spline.
struct SplineMass {
  static constexpr double breakpoint = CubicSplineLanes::breakpoint;
  template <KernelPiece piece>
  ACSTUDY_ALWAYS_INLINE static inline Lanes within(Lanes z) {
    return CubicSplineLanes{}.mass<piece>(z);
  }
  static constexpr int degree = 3;
  template <KernelPiece piece>
  static constexpr double primitive(int k) {
    constexpr double inside[] = {0.0, 0.0, 1.0, -1.0}, outside[] = {0.0, 1.0, -1.0, 1.0 / 3.0};
    return piece == KernelPiece::inside ? inside[k] : outside[k];
  }
};

/// coefficient[n], n < degree: the moment of a cell whose outer edge is at z and whose width is g, as a polynomial in
/// z.
template <class M, KernelPiece piece>
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
