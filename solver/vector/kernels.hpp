#pragma once

/// @file
/// Cell moments of the kernels for several particles at a time.

#include "solver/cells.hpp"
#include "solver/vector/lanes.hpp"

namespace acstudy {
inline namespace ACSTUDY_ISA {

/// Cells of particles, in units of the horizon; see Cell.
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
//   K::breakpoint               end of the piece `inside`, or 1
//   K::moment_scale             what first_moment has to be multiplied with
//   first_moment<piece>(cell)   proportional to the kernel's own; see solver/kernels.hpp
//   mass<piece>(cell)           likewise

/// eta(z) = 1/z.
struct InverseLanes {
  static constexpr double breakpoint = 1.0;
  static constexpr double moment_scale = 1.0;
  template <Piece>
  Lanes first_moment(const CellLanes& cell) const {
    return cell.width;
  }
};

/// The derivative of the cubic B-spline. Within a piece these are the formulas of CubicSplineKernel. Across the
/// breakpoint the outer polynomial is the inner one and a power of what is beyond 1/2:
/// eta = 32 z - 48 z^2 + 64 (z - 1/2)_+^2.
struct CubicSplineLanes {
  static constexpr double breakpoint = 0.5;

  template <Piece piece>
  Lanes mass(const CellLanes& cell) const {
    const auto& [a, b, width, rest_a, rest_b] = cell;
    if constexpr (piece == Piece::outside) {
      const Lanes sum = rest_a + rest_b;
      return width * (sum * sum - rest_a * rest_b) * (1.0 / 3.0);
    } else {
      const Lanes sum = a + b, inside = width * (sum * (1.0 - sum) + a * b);
      if constexpr (piece == Piece::inside) return inside;
      const Lanes p = max(a - 0.5, Lanes{}), q = max(b - 0.5, Lanes{});
      return inside + (4.0 / 3.0) * (q - p) * (p * p + p * q + q * q);
    }
  }

  static constexpr double moment_scale = 4.0 / 3.0;
  template <Piece piece>
  Lanes first_moment(const CellLanes& cell) const {
    const auto& [a, b, width, rest_a, rest_b] = cell;
    if constexpr (piece == Piece::outside) {
      const Lanes sum = rest_a + rest_b;
      return width * (sum * sum * (4.0 - 3.0 * sum) - rest_a * rest_b * (4.0 - 6.0 * sum));
    } else {
      const Lanes sum = a + b, inside = width * (sum * sum * (8.0 - 9.0 * sum) - a * b * (8.0 - 18.0 * sum));
      if constexpr (piece == Piece::inside) return inside;
      const Lanes p = max(a - 0.5, Lanes{}), q = max(b - 0.5, Lanes{});
      return inside + (q - p) * (8.0 * (p * p + p * q + q * q) + 12.0 * (p + q) * (p * p + q * q));
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

  static constexpr double moment_scale = 1.0;
  template <Piece>
  Lanes first_moment(const CellLanes& cells) const {
    return each(first_moment_, cells);
  }
  template <Piece>
  Lanes mass(const CellLanes& cells) const {
    return each(mass_, cells);
  }

 private:
  Lanes each(CellFunction function, const CellLanes& c) const {
    Lanes result;
    for (int i = 0; i < lane_count; ++i) {
      const Cell cell{c.inner[i], c.outer[i], c.width[i], c.rest_inner[i], c.rest_outer[i]};
      result[i] = cell.width > 0.0 ? function(kernel_, cell) : 0.0;
    }
    return result;
  }

  const void* kernel_;
  CellFunction first_moment_, mass_;
};

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
