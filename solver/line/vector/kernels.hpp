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

/// A table of the moment that is asked for. One of its pieces is the current one: the walk says when all lanes are in
/// it.
class TableLanes {
 public:
  explicit TableLanes(const SweepKernel& kernel) : kernel_(kernel), table_(kernel.moments) {}

  /// The current piece is a polynomial.
  bool goes_inside() const { return piece_ > 0 || table_.power >= 0; }
  /// Its ends, in units of the horizon.
  double begin() const { return table_.bounds[piece_]; }
  double end() const { return table_.bounds[piece_ + 1]; }

  static constexpr double moment_scale = 1.0;
  template <KernelPiece piece>
  ACSTUDY_ALWAYS_INLINE inline Lanes first_moment(Lanes z) {
    return within<piece>(z);
  }
  template <KernelPiece piece>
  ACSTUDY_ALWAYS_INLINE inline Lanes mass(Lanes z) {
    return within<piece>(z);
  }

 private:
  /// Anywhere: the piece of the nearest lane becomes the current one.
  template <KernelPiece piece>
  ACSTUDY_ALWAYS_INLINE inline Lanes within(Lanes z) {
    if constexpr (piece == KernelPiece::inside) return polynomial(piece_, z);
    const std::ptrdiff_t last = table_.pieces - 1;
    while (piece_ > 0 && !all_at_most(spread(begin()), z)) --piece_;
    while (piece_ < last && all_at_most(spread(end()), z)) ++piece_;
    Lanes value = on(piece_, z);
    for (std::ptrdiff_t i = piece_ + 1; i <= last; ++i) {
      const Choice beyond = at_most(spread(table_.bounds[i]), z);
      if (bits(beyond) == 0) break;
      value = select(beyond, on(i, z), value);
    }
    return value;
  }

  /// MomentTable::at() of all lanes.
  ACSTUDY_ALWAYS_INLINE inline Lanes on(std::ptrdiff_t piece, Lanes z) const {
    return piece == 0 && table_.power < 0 ? one_by_one(z) : polynomial(piece, z);
  }
  ACSTUDY_ALWAYS_INLINE inline Lanes polynomial(std::ptrdiff_t piece, Lanes z) const {
    const double* const c = table_.coefficient + piece * MomentTable::most_terms;
    const Lanes t = z - table_.origin[piece];
    std::ptrdiff_t k = table_.terms[piece] - 1;
    Lanes value = spread(c[k]);
    // Horner's rule, entered where the coefficients begin: a loop costs more than its steps.
    switch (k) {
      case 15:
        value = value * t + c[14];
        [[fallthrough]];
      case 14:
        value = value * t + c[13];
        [[fallthrough]];
      case 13:
        value = value * t + c[12];
        [[fallthrough]];
      case 12:
        value = value * t + c[11];
        [[fallthrough]];
      case 11:
        value = value * t + c[10];
        [[fallthrough]];
      case 10:
        value = value * t + c[9];
        [[fallthrough]];
      case 9:
        value = value * t + c[8];
        [[fallthrough]];
      case 8:
        value = value * t + c[7];
        [[fallthrough]];
      case 7:
        value = value * t + c[6];
        [[fallthrough]];
      case 6:
        value = value * t + c[5];
        [[fallthrough]];
      case 5:
        value = value * t + c[4];
        [[fallthrough]];
      case 4:
        value = value * t + c[3];
        [[fallthrough]];
      case 3:
        value = value * t + c[2];
        [[fallthrough]];
      case 2:
        value = value * t + c[1];
        [[fallthrough]];
      case 1:
        value = value * t + c[0];
        [[fallthrough]];
      default:
        break;
    }
    if (piece > 0) return value;
    if ((table_.power & 1) != 0) value *= z;
    if ((table_.power & 2) != 0) value *= z * z;
    for (int i = 4; i <= table_.power; i += 4) value *= z * z * (z * z);
    return value;
  }

  /// The function is compiled with the rest of the program, for any processor.
  ACSTUDY_NEVER_INLINE Lanes one_by_one(Lanes z) const {
    Lanes result = {};
    for (int i = 0; i < lane_count; ++i) result[i] = kernel_.moment(kernel_.kernel, z[i]);
    return result;
  }

  const SweepKernel& kernel_;
  const MomentTable::View table_;
  std::ptrdiff_t piece_ = 0;
};

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
