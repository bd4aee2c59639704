#pragma once

/// @file
/// What a run gives.

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "mms/points.hpp"
#include "solver/velocity.hpp"
#include "studies/cases/stored.hpp"

namespace acstudy {

/// The last state of a run that was given up, and what had become of its errors.
struct LastState {
  std::int64_t step = 0;  ///< steps done; 0 where the run went to its end
  double time = std::numeric_limits<double>::quiet_NaN();
  std::int64_t particle = -1;                               ///< the one that gave the run away
  double place = std::numeric_limits<double>::quiet_NaN();  ///< its position, beyond a line the first coordinate
  double error_linf = std::numeric_limits<double>::quiet_NaN();
  double error_l1 = std::numeric_limits<double>::quiet_NaN(), error_l2 = std::numeric_limits<double>::quiet_NaN();
};

/// Explicit steps against the bound of Lemma 2.4 or 3.3 at the smallest gap of the moment.
struct StepsAgainstBound {
  double largest = 0.0;         ///< largest dt over the bound; 0 where nothing is bounded
  std::int64_t first_step = 0;  ///< first step beyond the bound; 0: none
  double first_time = std::numeric_limits<double>::quiet_NaN();
  double first_place = std::numeric_limits<double>::quiet_NaN();  ///< left end of the smallest gap then
};

/// How the failure of a run begins for which there was not enough memory.
inline constexpr std::string_view over_memory = "there is not enough memory for ";
/// How the failure of a run begins that was ended because it took longer than its limit.
inline constexpr std::string_view over_limit = "took longer than its limit of ";

/// Parts of the seconds of a run, from a sample of its steps if there are many. Where threads share a pass over the
/// particles the clock of one of them tells its parts apart; what is in none is the step itself, the set-up, and the
/// wait for other threads.
struct PartSeconds {
  double positions_seconds = 0.0;  ///< where the particles are, and their phases
  double weights_seconds = 0.0;    ///< velocities, windows and weights
  double pairs_seconds = 0.0;      ///< the fluxes and the sums over pairs
  double source_seconds = 0.0;     ///< the manufactured source

  template <class Record, class Visit>
  static void stored(Record& r, Visit&& visit) {
    visit(Stored{.name = "positions_seconds", .timed = true}, r.positions_seconds);
    visit(Stored{.name = "weights_seconds", .timed = true}, r.weights_seconds);
    visit(Stored{.name = "pairs_seconds", .timed = true}, r.pairs_seconds);
    visit(Stored{.name = "source_seconds", .timed = true}, r.source_seconds);
  }
};

struct CaseResult : PartSeconds {
  bool completed = false;  ///< false: interrupted or put off, nothing else is meaningful
  std::string blow_up;     ///< how the solution left all bounds, if it did; the errors are then NaN
  std::string failure;     ///< why there is no solution for another reason, if so; the errors are then NaN
  std::string messages;    ///< the end of what an outside program wrote to stderr
  double error_linf = 0.0;
  double solution_linf = 0.0;  ///< largest exact |u|, or the reference's, at the particles, at first or at the end
  double error_l1 = 0.0, error_l2 = 0.0;  ///< weighted by cell width, divided by the period

  double seconds = 0.0;                          ///< wall time of the whole time loop, median over the repeats
  double seconds_low = 0.0, seconds_high = 0.0;  ///< fastest and slowest repeat
  std::int64_t repeats = 0;

  WorkCounts work;
  std::int64_t quadrature_points = 0;
  std::int64_t flow_evaluations = 0;  ///< particle positions computed after the start

  std::int64_t steps = 0;              ///< done
  std::int64_t rejected = 0;           ///< adaptive steps that were taken back besides
  double dt = 0.0, dt_smallest = 0.0;  ///< largest and smallest step
  StepsAgainstBound against_bound;
  LastState last;

  /// Fields at T, or the last finite ones of a run that was given up, shape [N]. Where no solution is known, u_exact is
  /// empty, or the reference at the particles.
  PointArray x;
  std::vector<double> u, u_exact;

  /// All of it: numbers, texts, and fields. This list alone says what is stored of a result, and read back.
  template <class Result, class Visit>
  static void stored(Result& r, Visit&& visit) {
    const bool bounded = r.against_bound.largest > 0.0, beyond = bounded && r.against_bound.first_step > 0;
    const bool given_up = !r.blow_up.empty() || !r.failure.empty();
    visit(Stored{"dt"}, r.dt);
    visit(Stored{"steps"}, r.steps);
    visit(Stored{.name = "rejected", .in_json = r.rejected > 0}, r.rejected);
    visit(Stored{"error_linf"}, r.error_linf);
    visit(Stored{"solution_linf"}, r.solution_linf);
    visit(Stored{"error_l1"}, r.error_l1);
    visit(Stored{"error_l2"}, r.error_l2);
    visit(Stored{.name = "seconds", .timed = true}, r.seconds);
    visit(Stored{.name = "seconds_low", .timed = true}, r.seconds_low);
    visit(Stored{.name = "seconds_high", .timed = true}, r.seconds_high);
    visit(Stored{.name = "repeats", .timed = true}, r.repeats);
    PartSeconds::stored(r, visit);
    visit(Stored{"pairs", "work"}, r.work.pairs);
    visit(Stored{"weight_builds", "work"}, r.work.weight_builds);
    visit(Stored{"quadrature_points", "work"}, r.quadrature_points);
    visit(Stored{"velocity_evaluations", "work"}, r.work.velocity_evaluations);
    visit(Stored{"flow_evaluations", "work"}, r.flow_evaluations);
    visit(Stored{.name = "dt_smallest", .in_json = r.dt_smallest != r.dt}, r.dt_smallest);
    visit(Stored{"largest", "bound", bounded}, r.against_bound.largest);
    visit(Stored{"first_step", "bound", beyond}, r.against_bound.first_step);
    visit(Stored{"first_time", "bound", beyond}, r.against_bound.first_time);
    visit(Stored{"first_place", "bound", beyond}, r.against_bound.first_place);
    visit(Stored{"step", "last", given_up}, r.last.step);
    visit(Stored{"time", "last", given_up}, r.last.time);
    visit(Stored{"particle", "last", given_up}, r.last.particle);
    visit(Stored{"place", "last", given_up}, r.last.place);
    visit(Stored{"error_linf", "last", given_up}, r.last.error_linf);
    visit(Stored{"error_l1", "last", given_up}, r.last.error_l1);
    visit(Stored{"error_l2", "last", given_up}, r.last.error_l2);
    visit(Stored{.name = "blow_up", .in_json = !r.blow_up.empty()}, r.blow_up);
    visit(Stored{.name = "failure", .in_json = !r.failure.empty()}, r.failure);
    visit(Stored{.name = "stderr", .in_json = !r.messages.empty(), .timed = true}, r.messages);
    visit(Stored{.name = "x", .in_json = false}, r.x);
    visit(Stored{.name = "u", .in_json = false}, r.u);
    visit(Stored{.name = "u_exact", .in_json = false}, r.u_exact);
  }
};

}  // namespace acstudy
