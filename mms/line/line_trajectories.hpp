#pragma once

/// @file
/// Trajectories on a line, with the phases of the particles.

#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "mms/line/trigonometric.hpp"
#include "mms/scene.hpp"

namespace acstudy {

class LineTrajectories : public Trajectories {
 public:
  /// @pre as for Trajectories, and scene.dimension() == 1
  LineTrajectories(const Scene& scene, std::vector<double> start) : Trajectories(scene, std::move(start)) {
    if (scene.flow()) angle_ = scene.flow()->angle(scene.period() / std::numbers::pi);
  }

  /// True if positions are computed from their phases, x = period/pi atan2(p, q).
  bool by_phases() const { return angle_.has_value(); }

  using Trajectories::at;
  /// Positions of the particles from number `begin` on, at time t, with their phases.  @pre closed_form()
  void at(double t, std::size_t begin, std::span<double> x, const PhasesOut& out) const {
    if (angle_) {
      scene_.flow()->evaluate(*at_start_, *angle_, begin, {t}, out.sine, out.cosine);
      phases_of_angles(scene_.period(), x, out);
    } else {
      at(t, begin, x);
      phases(x, scene_.period(), out);
    }
  }

 private:
  std::optional<Expression::Angle> angle_;  ///< of a flow that is period/pi atan2(p, q)
};

}  // namespace acstudy
