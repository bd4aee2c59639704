#pragma once

/// @file
/// Velocities as polynomials on overlapping panels, for midpoints of particles and their neighbors.

#include <optional>
#include <vector>

#include "mms/scene.hpp"
#include "solver/line/vector/sweeps.hpp"

namespace acstudy {

/// c_hat and b to round-off on panels that overlap.
class VelocityPanels {
 public:
  /// @param reach  largest distance from the middle of a vector of particles to a midpoint with a neighbor
  /// @return none where the fields are too rough for polynomials of degree below 32 on panels of that size
  static std::optional<VelocityPanels> find(const Scene& scene, double reach);

  /// The distance for which the panels are large enough.
  double reach() const { return panels_.radius - 0.5 * panels_.spacing; }
  SweepPanels view() const;

 private:
  SweepPanels panels_;
  std::vector<double> c_hat_, b_;
};

}  // namespace acstudy
