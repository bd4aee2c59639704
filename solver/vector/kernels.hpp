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

// What the sums ask of a kernel K. Its pieces end at K::breakpoint (1: there is one piece), and a cell within one of
// them needs no look at the other:
//
//   first_moment<piece>(cell), mass<piece>(cell)   as the kernel's own; see solver/kernels.hpp

enum class Piece { inside, outside, any };

/// eta(z) = 1/z.
struct InverseLanes {
  static constexpr double breakpoint = 1.0;
  template <Piece>
  Lanes first_moment(const CellLanes& cell) const {
    return cell.width;
  }
};

/// The derivative of the cubic B-spline; the formulas of CubicSplineKernel.
struct CubicSplineLanes {
  static constexpr double breakpoint = 0.5;

  template <Piece piece>
  Lanes mass(const CellLanes& cell) const {
    const auto inside = [](Lanes width, Lanes sum, Lanes product) { return width * (sum * (1.0 - sum) + product); };
    const auto outside = [](Lanes width, Lanes sum, Lanes product) {
      return width * (sum * sum - product) * (1.0 / 3.0);
    };
    return 16.0 * cut<piece>(cell, inside, outside);
  }
  template <Piece piece>
  Lanes first_moment(const CellLanes& cell) const {
    const auto inside = [](Lanes width, Lanes sum, Lanes product) {
      return width * (sum * sum * (8.0 - 9.0 * sum) - product * (8.0 - 18.0 * sum));
    };
    const auto outside = [](Lanes width, Lanes sum, Lanes product) {
      return width * (sum * sum * (4.0 - 3.0 * sum) - product * (4.0 - 6.0 * sum));
    };
    return (4.0 / 3.0) * cut<piece>(cell, inside, outside);
  }

 private:
  template <Piece piece, class Inside, class Outside>
  static Lanes cut(const CellLanes& cell, Inside inside, Outside outside) {
    const auto& [a, b, width, rest_a, rest_b] = cell;
    if constexpr (piece == Piece::inside) {
      return inside(width, a + b, a * b);
    } else if constexpr (piece == Piece::outside) {
      return outside(width, rest_a + rest_b, rest_a * rest_b);
    } else {
      const Lanes half = spread(0.5);
      const Lanes width_inside = min(max(half - a, Lanes{}), width);
      const Lanes a_in = min(a, half), b_in = min(b, half);
      const Lanes rest_a_out = min(rest_a, half), rest_b_out = min(rest_b, half);
      return inside(width_inside, a_in + b_in, a_in * b_in) +
             outside(width - width_inside, rest_a_out + rest_b_out, rest_a_out * rest_b_out);
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
