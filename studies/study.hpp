#pragma once

/// @file
/// What a study asks for: its schemes and paths, its series and cases.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mms/expression.hpp"
#include "mms/scene.hpp"
#include "mms/source.hpp"
#include "reports/orders.hpp"
#include "solver/integrators.hpp"
#include "studies/arrangement.hpp"
#include "studies/finding.hpp"
#include "studies/kernel_choice.hpp"

namespace acstudy {

struct SchemeChoice {
  int model;
  bool nonlocal_divergence;
  KernelChoice kernel;
  std::optional<double> mu;  ///< Model II; absent: max |c - b|
  std::string control;       ///< name of the mistake made on purpose; empty for the scheme itself
};

/// How long the steps of a run may be.
struct StepRule {
  /// Which bound steps follow: none, they are equal; that of Lemma 2.4 or 3.3 at the smallest gap of the moment; or
  /// what the proofs of these need of the rows, `Scheme::strongest_decay`, at the particles of the moment.
  enum class Bound { none, lemma, rows };
  Bound bound = Bound::none;
  double safety = 1.0;  ///< fraction of the bound that is taken
  std::string text;     ///< as a study writes it: "h/4", "cfl"

  /// "h/4", "0.9 cfl", "0.9 cfl by rows"
  std::string label() const;
};

/// The largest forward Euler step at a smallest gap: h_min / max|c_hat| (Lemma 2.4), h_min / (2 mu) (Lemma 3.3).
inline double lemma_step(const SchemeChoice& scheme, double h_min, double max_c_hat, double mu) {
  return h_min / (scheme.model == 1 ? max_c_hat : 2.0 * mu);
}

/// Everything that fixes the numbers of one run.
struct Case {
  std::shared_ptr<const Scene> scene;
  SchemeChoice scheme;
  double mu;  ///< of Model II; 0 for Model I
  bool nonlocal_source;
  SourceRule source_rule;
  const Integrator* integrator;
  std::int64_t N;
  double h, delta;
  double dt;           ///< of equal steps; with a bound, the first one by Lemma 2.4 or 3.3
  std::int64_t steps;  ///< equal ones; with a bound, as many of the first one
  Start start = {};
  StepRule step = {};
  bool readable = false;              ///< run in the readable form of the scheme even where there is a vector form
  std::size_t source_refinement = 1;  ///< how many times the points of the Gauss rule a nonlocal source gets

  /// Text that is equal for two cases exactly if all their inputs are equal.
  std::string key() const;
  /// Rough number of pair interactions, to start the longest case first.
  double estimated_work() const;
  /// `lemma_step` of this case.
  double lemma_bound(double h_min) const;
  /// CFL number at the start: dt over the bound of the lemma.
  double cfl() const { return dt / lemma_bound(h * start.smallest_gap); }
  /// Twice as many steps of half the length.
  void halve_steps();
};

/// What theory says of a series.
struct Theory {
  std::string variable;  ///< "h" or "max(h,delta)"
  double order;          ///< 0: the error does not vanish along this path
  std::string statement;
};

/// The run that the errors of a series are against, as a level that is none.
struct ReferenceLevel {
  std::int64_t N;
  double variable;  ///< of theory
};

/// One scheme along one path.
struct Series {
  SchemeChoice scheme;
  std::string path, delta_text;
  std::string stepping;  ///< integrator and steps as a label, where a study has several; else empty
  bool nonlocal_source;
  Theory theory;
  Verdict expected;
  std::vector<Case> cases;         ///< coarse to fine
  bool against_reference = false;  ///< the last case is no level: the others' errors are against it

  /// Number of cases that are judged.
  std::size_t levels() const { return cases.size() - (against_reference ? 1 : 0); }
  std::optional<ReferenceLevel> reference_level() const;
  /// Value of theory's variable at a case.
  double variable(double h, double delta) const { return theory.variable == "h" ? h : std::max(h, delta); }
  std::string label() const;
};

/// "Model I, local divergence, inverse"; the divergence is left out where particles stand still.
std::string scheme_label(const SchemeChoice& scheme, bool standing);

struct SeriesResult;

/// One statement to be measured; `take` gets the results of the study's series, which may be none.
struct Measurement {
  std::string name;
  std::function<Finding(const std::vector<SeriesResult>&)> take;
};

/// What a study file asks for. A convergence study is judged by its series. Studies of other kinds are judged by what
/// they measure; their series are the runs that this needs.
struct Study {
  std::string file, text;
  std::string name, title, kind;
  std::shared_ptr<const Scene> scene;  ///< none where a kind needs none
  SourceRule source_rule = SourceRule::gauss;
  std::vector<Series> series;
  std::vector<Measurement> measurements;

  bool judged_by_series() const { return kind == "convergence"; }
};

}  // namespace acstudy
