#pragma once

/// @file
/// The particles of several cases, with what all their sweeps see: positions, velocities, phases.

#include <functional>
#include <optional>
#include <vector>

#include "mms/line/line_trajectories.hpp"
#include "solver/line/particles.hpp"
#include "solver/line/vector/sweeps.hpp"
#include "studies/running/ensemble/team.hpp"
#include "studies/running/ensemble/velocity_panels.hpp"

namespace acstudy {

/// The modes that c and b have at midpoints.
struct MidpointModes {
  std::vector<int> number;  ///< n of each, at most `most_modes`
  SweepField c, b;
};
/// The velocities of a scene as short trigonometric series, where they are such; those of b where particles move.
struct VelocitySeries {
  std::optional<TrigonometricSeries> c, b, b_prime;
  std::optional<TrigonometricSeries> c_hat;  ///< c - b, where both are
  std::optional<MidpointModes> modes;        ///< none where c and b are no series of few enough modes
  explicit VelocitySeries(const Scene& scene);
};

/// An upper bound of the distance from the middle of a vector of particles to their midpoints with neighbors, with some
/// room for gaps that grow.
double midpoint_reach(double delta, double largest_gap);

/// What the sweeps of some cases need at the particles.
struct Needs {
  bool c_hat = false;      ///< (Model I)
  bool c_and_b = false;    ///< (its nonlocal divergence)
  bool b_prime = false;    ///< (local divergence)
  bool midpoints = false;  ///< (Model II)
  bool phases = false;     ///< (sources that are series)
  bool rows = false;       ///< (implicit steps)
  double delta = 0.0;      ///< the largest horizon
};

class SharedParticles {
 public:
  /// @param scene, velocity  outlive the particles
  SharedParticles(const Scene& scene, const VelocitySeries& velocity, std::vector<double> start, Needs needs,
                  Team& team);

  /// What is done with the particles of a piece, each alone, once they are where they are meant to be.
  using AndThen = std::function<void(const Piece&, Laps&)>;

  /// Takes the particles to time t and computes what is needed there, if they are not there already.
  /// @throws std::domain_error if particles have crossed, or the flow cannot be integrated
  void move(double t, const AndThen& and_then = {});
  /// Positions at time t, for a look at the solution.
  std::span<const double> positions(double t);

  std::size_t size() const { return x.size(); }
  const Scene& scene() const { return scene_; }
  Phases phases(const Piece& piece) const { return {piece.of(cosine_.values()), piece.of(sine_.values())}; }
  double smallest_gap() const { return smallest_gap_; }
  /// Where it begins.
  double place_of_smallest_gap() const;
  /// The largest distance at which a neighbor is inside.
  double inside(double delta) const { return inside_horizon(delta, x[0], x[std::ssize(x) - 1], scene_.period()); }
  /// How far ghosts have to reach for sums at a horizon of at most the one that was said to be needed.
  std::ptrdiff_t reach(double delta) const;
  std::int64_t times_moved() const { return times_moved_; }

  // with ghosts
  PeriodicArray x;
  PeriodicArray c, b, b_prime, c_hat;
  std::optional<MidpointModes> modes;                 ///< of the velocities; none where
  std::optional<VelocityPanels> panels;               ///< these are used
  std::vector<PeriodicArray> mode_cosine, mode_sine;  ///< cos(n w x/2) and sin(n w x/2) of each of `modes`

  double positions_seconds = 0.0, velocities_seconds = 0.0;

 private:
  /// Positions at time t, if they are not there yet, and phases.
  void place(std::optional<double> t, const Piece& piece);
  void fill(const Piece& piece);
  void fit_panels();
  void wrap_positions();
  void wrap_fields();

  const Scene& scene_;
  Needs needs_;
  Team& team_;
  const VelocitySeries& series_;
  std::optional<LineTrajectories> trajectories_;  ///< none where particles stand still
  std::vector<double> start_;
  PeriodicArray cosine_, sine_;            ///< of w x, where they are needed
  PeriodicArray half_cosine_, half_sine_;  ///< of w x/2, where there are `modes`
  double t_ = -1.0, smallest_gap_ = 0.0;
  std::ptrdiff_t wrapped_;  ///< ghosts of x at each end
  std::int64_t times_moved_ = 0;
};

}  // namespace acstudy
