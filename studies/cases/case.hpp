#pragma once

/// @file
/// One run: everything that fixes its numbers.

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "mms/scene.hpp"
#include "mms/source.hpp"
#include "solver/time/integrators.hpp"
#include "studies/cases/stored.hpp"
#include "studies/models/arrangement.hpp"
#include "studies/models/scheme_choice.hpp"

namespace acstudy {

/// How long the steps of a run may be.
struct StepRule {
  /// Which bound steps follow: none, they are equal; that of Lemma 2.4 or 3.3 at the smallest gap of the moment; what
  /// the proofs of these need of the rows, `SchemeRows::strongest_decay`, at the particles of the moment; or the
  /// tolerance of the error that each step is estimated to have.
  enum class Bound { none, lemma, rows, tolerance };
  Bound bound = Bound::none;
  double safety = 1.0;     ///< fraction of the bound that is taken
  std::string text;        ///< as a study writes it: "h/4", "cfl"; of adaptive steps their tolerance, "1e-2*h^2"
  double tolerance = 0.0;  ///< see error_over(); 0 unless steps follow it

  bool adaptive() const { return bound == Bound::tolerance; }
  /// "h/4", "0.9 cfl", "0.9 cfl by rows", "adaptive to 1e-4"
  std::string label() const;
};

/// Everything that fixes the numbers of one run.
struct Case {
  std::shared_ptr<const Scene> scene;
  SchemeChoice scheme;
  double mu;  ///< of a viscous model; else 0
  bool nonlocal_source;
  SourceRule source_rule;
  const Integrator* integrator;
  std::int64_t N;
  double h, delta;
  double dt;           ///< of equal steps; with a bound, the first one by Lemma 2.4 or 3.3; the first adaptive one
  std::int64_t steps;  ///< equal ones; with a bound, as many of the first one; of adaptive ones a guess
  Start start = {};
  StepRule step = {};
  bool readable = false;              ///< run in the readable form of the scheme even where there is a vector form
  std::size_t source_refinement = 1;  ///< how many times the points of the Gauss rule a nonlocal source gets
  std::string path = {};              ///< its name, which a program is told
  /// Seconds that the run may take; they decide no number, and are no part of the key. A program has its timeout.
  double limit = std::numeric_limits<double>::infinity();

  /// Its inputs that are stored case by case; what a series has in common is stored with the series.
  template <class Visit>
  void stored(Visit&& visit) const {
    visit(Stored{"N"}, N);
    visit(Stored{"h"}, h);
    visit(Stored{"delta"}, delta);
    visit(Stored{.name = "tolerance", .in_json = step.adaptive()}, step.tolerance);
  }

  /// Text that is equal for two cases exactly if all their inputs are equal.
  std::string key() const;
  /// Roughly what the run takes, in pair interactions of the vector form: to start the longest case first, and to say
  /// how long the rest takes.
  double estimated_work() const;
  /// Bytes of the fields that its result keeps.
  double result_bytes() const;
  /// Roughly what else the program needs of memory while it runs this case.
  double working_bytes() const;
  /// The largest forward Euler step that the lemma of the model allows at a smallest gap.
  double lemma_bound(double h_min) const;
  /// CFL number at the start: dt over the bound of the lemma.
  double cfl() const { return dt / lemma_bound(h * start.smallest_gap); }
  /// Twice as many steps of half the length.  @pre they are not adaptive
  void halve_steps();
};

}  // namespace acstudy
