#pragma once

/// @file
/// The cells between neighbors, over which kernels are integrated.

#include <algorithm>

namespace acstudy {

/// A cell [inner, outer] of distances in units of the horizon, 0 <= inner <= outer <= 1.
///
/// Its width and the distances of its ends to the horizon are kept beside the ends, each exact to the last place.
/// Computed from the ends they would not be: with 1e4 neighbors `outer - inner` has four digits fewer, and so has
/// `1 - outer` near the horizon.
struct Cell {
  double inner, outer;
  double width;                   ///< outer - inner
  double rest_inner, rest_outer;  ///< 1 - inner, 1 - outer
};

/// The cells of one particle on one side, from the particle outward to the horizon.
class CellWalk {
 public:
  /// @param delta  horizon, > 0
  explicit CellWalk(double delta) : delta_(delta), per_delta_(1.0 / delta) {}

  /// The next cell, up to the neighbor at distance d, which is `gap` beyond the one before.
  Cell to(double d, double gap) {
    Cell cell = to_horizon();
    // A neighbor at exactly the horizon may stand slightly beyond it by round-off; its cell ends at the horizon.
    cell.outer = outer_ = std::min(d * per_delta_, 1.0);
    cell.rest_outer = rest_ = std::max((delta_ - d) * per_delta_, 0.0);
    cell.width = std::min(gap * per_delta_, cell.rest_inner);
    return cell;
  }
  /// The last cell.
  Cell to_horizon() const { return {outer_, 1.0, rest_, rest_, 0.0}; }

 private:
  double delta_, per_delta_;
  double outer_ = 0.0, rest_ = 1.0;  ///< of the cell before
};

}  // namespace acstudy
