#pragma once

/// @file
/// Cell moments of the kernels for several particles at a time.

#include "solver/cells.hpp"
#include "solver/vector/lanes.hpp"

namespace acstudy {
inline namespace ACSTUDY_ISA {

/// Cells of particles; see Cell. Distances are in units of the horizon, the width is not.
struct CellLanes {
  Lanes inner, outer;
  Lanes width;
  Lanes rest_inner, rest_outer;
};

/// Where a cell lies: within a piece of the kernel, or possibly across its breakpoint.
enum class Piece { inside, outside, any };

// What the sums ask of a kernel K. A constant factor that all cells of a particle share is put in last (Model I) or
// cancels (Model II):
//
//   K::breakpoint                      end of the piece `inside`, or 1
//   moment_scale(delta)                what first_moment has to be multiplied with
//   first_moment<piece>(cell, delta)   proportional to the kernel's own; see solver/kernels.hpp
//   mass<piece>(cell, delta)           likewise

/// eta(z) = 1/z.
struct InverseLanes {
  static constexpr double breakpoint = 1.0;
  static double moment_scale(double delta) { return 1.0 / delta; }
  template <Piece>
  Lanes first_moment(const CellLanes& cell, double) const {
    return cell.width;
  }
};

/// The derivative of the cubic B-spline. Within a piece these are the formulas of CubicSplineKernel. Across the
/// breakpoint the outer polynomial is the inner one and a power of what is beyond 1/2:
/// eta = 32 z - 48 z^2 + 64 (z - 1/2)_+^2.
struct CubicSplineLanes {
  static constexpr double breakpoint = 0.5;

  template <Piece piece>
  Lanes mass(const CellLanes& cell, double delta) const {
    const auto& [a, b, width, rest_a, rest_b] = cell;
    if constexpr (piece == Piece::outside) {
      const Lanes sum = rest_a + rest_b;
      return width * (sum * sum - rest_a * rest_b) * (1.0 / 3.0);
    } else {
      const Lanes sum = a + b, inside = width * (sum * (1.0 - sum) + a * b);
      if constexpr (piece == Piece::inside) return inside;
      const Lanes p = max(a - 0.5, Lanes{}), q = max(b - 0.5, Lanes{});
      return inside + (4.0 / 3.0 * delta) * ((q - p) * (p * p + p * q + q * q));
    }
  }

  static double moment_scale(double delta) { return 4.0 / (3.0 * delta); }
  template <Piece piece>
  Lanes first_moment(const CellLanes& cell, double delta) const {
    const auto& [a, b, width, rest_a, rest_b] = cell;
    if constexpr (piece == Piece::outside) {
      const Lanes sum = rest_a + rest_b;
      return width * (sum * sum * (4.0 - 3.0 * sum) - rest_a * rest_b * (4.0 - 6.0 * sum));
    } else {
      const Lanes sum = a + b, inside = width * (sum * sum * (8.0 - 9.0 * sum) - a * b * (8.0 - 18.0 * sum));
      if constexpr (piece == Piece::inside) return inside;
      const Lanes p = max(a - 0.5, Lanes{}), q = max(b - 0.5, Lanes{});
      return inside + delta * ((q - p) * (8.0 * (p * p + p * q + q * q) + 12.0 * (p + q) * (p * p + q * q)));
    }
  }
};

/// Any other kernel, one particle after the other.
///
/// The functions are compiled with the rest of the program, for any processor.
class ScalarLanes {
 public:
  static constexpr double breakpoint = 1.0;
  using CellFunction = double (*)(const void* kernel, const Cell& cell);

  ScalarLanes(const void* kernel, CellFunction cell_moment, CellFunction cell_mass)
      : kernel_(kernel), first_moment_(cell_moment), mass_(cell_mass) {}

  static double moment_scale(double) { return 1.0; }
  template <Piece>
  Lanes first_moment(const CellLanes& cells, double delta) const {
    return each(first_moment_, cells, delta);
  }
  template <Piece>
  Lanes mass(const CellLanes& cells, double delta) const {
    return each(mass_, cells, delta);
  }

 private:
  Lanes each(CellFunction function, const CellLanes& c, double delta) const {
    Lanes result;
    for (int i = 0; i < lane_count; ++i) {
      const Cell cell{c.inner[i], c.outer[i], c.width[i] / delta, c.rest_inner[i], c.rest_outer[i]};
      result[i] = cell.width > 0.0 ? function(kernel_, cell) : 0.0;
    }
    return result;
  }

  const void* kernel_;
  CellFunction first_moment_, mass_;
};

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
