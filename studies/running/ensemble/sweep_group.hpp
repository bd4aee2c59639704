#pragma once

/// @file
/// Schemes of one model, kernel and horizon, whose rates come from one sweep over pairs.

#include <functional>
#include <memory>
#include <span>

#include "solver/line/vector/sweeps.hpp"
#include "solver/time/implicit.hpp"
#include "solver/velocity.hpp"
#include "studies/cases/case.hpp"
#include "studies/running/ensemble/shared_particles.hpp"

namespace acstudy {

/// The values of one case during its run.
struct SweptValues {
  PeriodicArray u;
  PeriodicArray flux;  ///< c_hat u, of Model I on moving particles
  ZeroedVector rate;   ///< [N] and the rest of a vector
  ImplicitSolver solver = {};
  double factorized_for = 0.0;  ///< the scale, where particles stand still; 0: for none
  std::string failure = {};     ///< of the last solve()
};

class SweepGroup {
 public:
  /// @param c          one of the group's cases
  /// @param particles  outlive the group
  /// @param far        sums over far neighbors are by boxes  @pre far_pays(), whatever the number of neighbors
  SweepGroup(const Case& c, const SharedParticles& particles, bool far);
  ~SweepGroup();
  SweepGroup(SweepGroup&&) noexcept;

  /// True if a case on moving particles has so many neighbors that sums over far ones by boxes are the faster.
  /// @param modes  the scene's velocities are series of few modes
  /// @param both   the sums are for both divergences
  static bool far_pays(const Case& c, bool modes, bool both);

  /// True if the case can be added: the same model, kernel, horizon and viscosity, and another divergence than those
  /// already there.
  bool takes(const Case& c) const;
  /// Adds a case. `values` stay where they are.
  void add(const Case& c, SweptValues& values);
  void remove(const SweptValues& values);
  bool empty() const { return local_ == nullptr && nonlocal_ == nullptr; }

  /// What rates(), called after it, needs to be known of all particles first: the fluxes of Model I.
  void prepare(const Piece& piece, Laps& laps);

  /// Called with a piece of particles as soon as their rates are known, while others' are not.
  /// It may change no u that the group sees.
  using AndThen = std::function<void(const Piece&)>;

  /// rate = rate(u) of every case. The particles must be where they are meant to be.
  void rates(Team& team, const AndThen& and_then);

  /// u <- U with U - scale rate(U) = u, of every case that does not fail.  The particles must be where they are meant
  /// to be.
  void solve(Team& team, double scale);

  /// One over the largest step that rows allow at the particles where they are; see KnowsItsRows.
  double strongest_decay(Team& team);

  /// Pair interactions and weight builds of each of the group's cases so far.
  const WorkCounts& work() const { return work_; }

  double seconds = 0.0;  ///< spent in sweeps, and in fluxes

 private:
  struct Kernel;
  UpwindSweep upwind_sweep(const SweepScheme& local, const SweepScheme& nonlocal) const;
  SymmetricSweep symmetric_sweep(const SweepScheme& local, const SweepScheme& nonlocal) const;
  void sweep_moving(Team& team, const AndThen& and_then);
  void sweep_standing(Team& team, const AndThen& and_then);
  /// Assembles the rows, or no more than their decay.
  void sweep_rows(Team& team, bool decay_alone);

  const SharedParticles& particles_;
  bool far_;
  std::unique_ptr<Kernel> kernel_;
  const ModelCard* model_;
  double delta_, mu_;
  std::string kernel_label_;
  SweptValues *local_ = nullptr, *nonlocal_ = nullptr;
  std::unique_ptr<BandedMatrix> standing_;  ///< where particles stand still
  RateMatrix standing_entries_;             ///< the same, for implicit steps
  std::int64_t standing_pairs_ = 0;
  BandedMatrix rows_;  ///< where particles move and steps are implicit; but for the diagonal,
  std::ptrdiff_t room_ = 0;
  ZeroedVector own_local_, own_nonlocal_;  ///< which is here
  bool by_rows_;                           ///< steps follow the rows
  ZeroedVector decay_;
  double strongest_decay_ = 0.0;
  std::int64_t decay_known_for_ = -1;  ///< the move of the particles after which it was found
  WorkCounts work_;
};

}  // namespace acstudy
