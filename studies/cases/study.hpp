#pragma once

/// @file
/// What a study asks for: its series of cases and its measurements.

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "reports/judging/orders.hpp"
#include "studies/cases/case.hpp"
#include "studies/cases/measurement.hpp"
#include "studies/models/theory.hpp"

namespace acstudy {

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
