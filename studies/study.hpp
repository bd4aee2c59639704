#pragma once

/// @file
/// What a study asks for: its schemes and paths, its series and cases.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mms/expression.hpp"
#include "mms/scene.hpp"
#include "mms/source.hpp"
#include "reports/orders.hpp"
#include "solver/integrators.hpp"
#include "studies/kernel_choice.hpp"

namespace acstudy {

struct SchemeChoice {
  int model;
  bool nonlocal_divergence;
  KernelChoice kernel;
  std::optional<double> mu;  ///< Model II; absent: max |c - b|
};

/// A refinement path: the curve delta(h) and the levels on it.
struct PathChoice {
  std::string name;
  Expression delta;
  std::vector<std::int64_t> N;
  bool nonlocal_source;
  std::optional<Verdict> expect;
  std::optional<double> order;  ///< in place of theory's
};

/// Everything that fixes the numbers of one run.
struct Case {
  std::shared_ptr<const Scene> scene;
  SchemeChoice scheme;
  double mu;  ///< of Model II; 0 for Model I
  bool nonlocal_source;
  SourceRule source_rule;
  const Integrator* integrator;
  std::int64_t N;
  double h, delta, dt;
  std::int64_t steps;

  /// Text that is equal for two cases exactly if all their inputs are equal.
  std::string key() const;
  /// Rough number of pair interactions, to start the longest case first.
  double estimated_work() const;
  /// CFL number: dt max|c_hat| / h (Lemma 2.4) or 2 dt mu / h (Lemma 3.3) at the uniform start.
  double cfl() const;
};

/// What theory says of a series.
struct Theory {
  std::string variable;  ///< "h" or "max(h,delta)"
  double order;          ///< 0: the error does not vanish along this path
  std::string statement;
};

/// One scheme along one path.
struct Series {
  SchemeChoice scheme;
  std::string path, delta_text;
  bool nonlocal_source;
  Theory theory;
  Verdict expected;
  std::vector<Case> cases;

  /// Value of theory's variable at a case.
  double variable(double h, double delta) const { return theory.variable == "h" ? h : std::max(h, delta); }
  std::string label() const;
};

/// "Model I, local divergence, inverse, delta = 4h"; the divergence is left out where particles stand still.
std::string series_label(int model, bool standing, bool nonlocal_divergence, const KernelChoice& kernel,
                         const std::string& path);

struct Study {
  std::string file, text;
  std::string name, title;
  std::shared_ptr<const Scene> scene;
  const Integrator* integrator;
  std::string step_text;
  SourceRule source_rule;
  std::vector<Series> series;
};

}  // namespace acstudy
