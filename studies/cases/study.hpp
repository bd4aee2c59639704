#pragma once

/// @file
/// What a study asks for: its series of cases and its measurements.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "reports/judging/orders.hpp"
#include "studies/cases/case.hpp"
#include "studies/cases/measurement.hpp"
#include "studies/models/outside_program.hpp"
#include "studies/models/theory.hpp"

namespace acstudy {

/// An order is extrapolated from so many levels on.
inline constexpr std::size_t fewest_levels = 4;

/// One scheme along one path.
struct Series {
  SchemeChoice scheme;
  std::string path, delta_text;
  std::string stepping;  ///< integrator and steps as a label, where a study has several; else empty
  bool nonlocal_source;
  Theory theory;
  Verdict expected;
  std::vector<Case> cases;         ///< coarse to fine
  bool until_decided = false;      ///< after the fewest levels one at a time is added, until the verdict is decided
  bool against_reference = false;  ///< the last case is no level: the others' errors are against it

  /// Number of cases that are judged.
  std::size_t levels() const { return cases.size() - (against_reference ? 1 : 0); }
  std::optional<ReferenceLevel> reference_level() const;
  /// Number of cases that are run whatever comes of them.
  std::size_t cases_at_first() const { return until_decided ? fewest_levels : cases.size(); }
  /// Value of theory's variable at a case.
  double variable(double h, double delta) const { return theory.variable == "h" ? h : std::max(h, delta); }
  std::string label() const;

  /// What it is, with what its cases have in common. This list alone says what is stored of a series.
  template <class Visit>
  void stored(Visit&& visit) const {
    const Case& first = cases.front();
    const auto which = [](bool nonlocal) { return std::string(nonlocal ? "nonlocal" : "local"); };
    const bool program = scheme.program != nullptr;
    visit(Stored{"model"}, static_cast<std::int64_t>(scheme.model->number));
    visit(Stored{"divergence"}, program ? std::string() : which(scheme.nonlocal_divergence));
    visit(Stored{"kernel"}, scheme.kernel.name);
    if (program) {
      visit(Stored{"label"}, scheme.program->label);
      visit(Stored{"command"}, scheme.program->command_line());
    } else if (const KernelParameter* const parameter = scheme.kernel.family()) {
      visit(Stored{parameter->name().data()}, scheme.kernel.parameter);  // the end of a literal
    }
    if (scheme.model->beyond_paper) visit(Stored{"label"}, scheme.model->label());
    if (scheme.model->viscous) visit(Stored{"mu"}, first.mu);
    visit(Stored{"path"}, path);
    visit(Stored{.name = "delta", .in_hdf5 = "delta_text"}, delta_text);
    visit(Stored{"source"}, which(nonlocal_source));
    visit(Stored{"integrator"}, std::string(first.integrator->name));
    visit(Stored{.name = "step", .in_hdf5 = "step_text"}, first.step.label());
    visit(Stored{"start"}, first.start.label());
    visit(Stored{.name = "stepping", .in_json = !stepping.empty()}, stepping);
    visit(Stored{"motion"}, std::string(first.scene->standing() ? "standing" : "moving"));
    visit(Stored{"variable", "theory"}, theory.variable);
    visit(Stored{"order", "theory"}, theory.order);
    visit(Stored{"statement", "theory"}, theory.statement);
  }
};

/// What a study file asks for: what it measures, and the series of runs that this needs.
struct Study {
  std::string file, text;
  std::string name, title, kind;
  std::shared_ptr<const Scene> scene;  ///< none where a kind needs none
  SourceRule source_rule = SourceRule::gauss;
  std::vector<Series> series;
  std::vector<Measurement> measurements;
};

}  // namespace acstudy
