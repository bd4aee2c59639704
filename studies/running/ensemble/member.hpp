#pragma once

/// @file
/// A case of an ensemble on its way.

#include <algorithm>
#include <optional>

#include "solver/time/integrate.hpp"
#include "studies/running/ensemble/particle_source.hpp"
#include "studies/running/ensemble/sweep_group.hpp"
#include "studies/running/watch.hpp"

namespace acstudy {

struct Member {
  Member(const Case& its_case, std::size_t count, const Team& team);

  /// u at the start of the step, from its first stage to that of the next.
  PeriodicArray& before() { return u_n.size() > 0 ? u_n : next; }

  /// Before the first piece of a stage.
  void start_stage() {
    largest.fill(0.0);
    largest_error.fill(0.0);
  }
  /// `next`, `largest` and what is estimated of the error: stage i of a step of length dt at the particles of a piece,
  /// whose rates are there.
  void stage(std::size_t i, double dt, const Piece& piece);
  /// Makes what stage i has given the state; after all pieces.
  void accept(std::size_t i);
  // An implicit stage i goes on from there. At the particles of a piece: the source comes into the state, before it is
  // solved for, with `scale` as its step;
  void add_source(std::size_t i, double scale, const Piece& piece);
  /// and then `largest`, the rate of the stage, if it is asked for, and what it has in the estimated error.
  void finish_solved(std::size_t i, double scale, const Piece& piece);
  /// Puts back the state at the start of a step of which `stages_done` stages are done.
  void take_back(std::size_t stages_done) {
    if (stages_done > 0) std::swap(values.u, before());
  }

  /// The estimated error of the step done over what is tolerated, see acstudy::error_over().
  double error_over(double tolerance) const {
    return acstudy::error_over(tolerance, largest_error.all(larger), largest_before, largest.all(larger));
  }
  /// Undoes the step done, which is rejected.
  void reject() {
    take_back(c.integrator->stage_count());
    bound.take_back();
    std::fill(values.rate.begin(), values.rate.end(), 0.0);  // stages multiply what they do not ask for by zero
    ++result.rejected;
  }

  /// Adds what F_k, the rates of the piece and `f`, has in the estimated error of a step of length dt.
  /// @param f  from the piece's first particle on
  void estimate(std::size_t k, double dt, const double* f, const Piece& piece);

  const Case& c;
  CaseResult result;
  SweptValues values;
  PeriodicArray next;         ///< what becomes of u
  PeriodicArray u_n;          ///< at the start of the step, where there are several stages
  std::vector<double> right;  ///< of an implicit stage, where its rate is asked for
  ZeroedVector no_source;     ///< for rates that have it already
  StageRegisters registers;
  SweepGroup* group = nullptr;
  ParticleSource* source = nullptr;
  std::optional<ParticleSource> own_source;
  std::optional<GrowthWatch> growth;
  BoundWatch bound;
  double lemma_bound = 0.0;  ///< for a smallest gap of 1
  double solution_at_first = 0.0;
  PerThread<double> largest;  ///< |u| after the last stage
  ZeroedVector error;         ///< estimated of the step; empty where none is
  PerThread<double> largest_error;
  double largest_before = 0.0;  ///< |u| at the start of the step
  double t = 0.0;
  bool running = true;
  bool put_off = false;  ///< left where it is, to be run another time
};

}  // namespace acstudy
