#pragma once

/// @file
/// Moments of the kernels for several particles at a time.

#include "solver/line/vector/lanes.hpp"
#include "solver/line/vector/sweeps.hpp"

namespace acstudy {
inline namespace ACSTUDY_ISA {

/// Where a cell lies: within a piece of the kernel, or possibly across its breakpoint.
enum class KernelPiece { inside, any, outside };

// What the sums ask of a kernel K: its moments within a distance z, in units of the horizon. That of a cell is the
// difference at its ends. Its round-off is no larger than what the last digit of a neighbor's distance makes, and what
// one cell loses the next one gains. A constant factor that all cells of a particle share is put in last (Model I) or
// cancels (Model II):
//
//   K::breakpoint            end of the piece `inside`, or 1
//   K::moment_scale          what first_moment has to be multiplied with
//   first_moment<piece>(z)   proportional to the kernel's own; see solver/kernels.hpp
//   mass<piece>(z)           likewise

/// eta(z) = 1/z.
struct InverseLanes {
  static constexpr double breakpoint = 1.0;
  static constexpr double moment_scale = 1.0;
  template <KernelPiece>
  Lanes first_moment(Lanes z) const {
    return z;
  }
};

/// The derivative of the cubic B-spline. Inside and outside of the breakpoint these are the formulas of
/// CubicSplineKernel. On both sides the polynomial is the inner one and a power of what is beyond 1/2:
/// eta = 32 z - 48 z^2 + 64 (z - 1/2)_+^2.
struct CubicSplineLanes {
  static constexpr double breakpoint = 0.5;

  template <KernelPiece piece>
  Lanes mass(Lanes z) const {
    if constexpr (piece == KernelPiece::outside) {
      const Lanes rest = 1.0 - z;
      return 1.0 / 6.0 - rest * rest * (1.0 / 3.0 * rest);
    } else {
      const Lanes z_2 = z * z, inner = z_2 - z_2 * z;
      if constexpr (piece == KernelPiece::inside) return inner;
      const Lanes p = max(z - 0.5, Lanes{});
      return inner + p * p * (4.0 / 3.0 * p);
    }
  }

  static constexpr double moment_scale = 4.0 / 3.0;
  template <KernelPiece piece>
  Lanes first_moment(Lanes z) const {
    if constexpr (piece == KernelPiece::outside) {
      const Lanes rest = 1.0 - z;
      return 0.75 - rest * rest * rest * (4.0 - 3.0 * rest);
    } else {
      const Lanes inner = z * z * z * (8.0 - 9.0 * z);
      if constexpr (piece == KernelPiece::inside) return inner;
      const Lanes p = max(z - 0.5, Lanes{});
      return inner + p * p * p * (8.0 + 12.0 * p);
    }
  }
};

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
