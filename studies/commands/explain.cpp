#include "studies/commands/explain.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "solver/line/particles.hpp"
#include "studies/cases/lints.hpp"
#include "studies/commands/bytes.hpp"
#include "studies/commands/seconds.hpp"
#include "studies/models/outside_program.hpp"

namespace acstudy {

namespace {

const char* text(SourceRule rule) {
  switch (rule) {
    case SourceRule::gauss:
      return "a Gauss rule of the kernel's own weight";
    case SourceRule::gsl:
      return "adaptive GSL quadrature";
    case SourceRule::boost:
      return "adaptive Boost.Math quadrature";
  }
  return "";
}

/// What every series of the study does without, and why.
std::string left_out(const Study& study) {
  // What a program does without is its own affair.
  const auto any = [&](auto&& predicate) {
    return std::any_of(study.series.begin(), study.series.end(),
                       [&](const Series& s) { return s.scheme.program == nullptr && predicate(s); });
  };
  const bool any_of_acstudy = any([](const Series&) { return true; });
  std::string out;
  const auto line = [&](const std::string& what) { out += "  - " + what + "\n"; };
  if (study.scene->standing() && any_of_acstudy) {
    line(
        "particle motion: b is absent, so no flow, no b terms; windows, weights and velocities once a case "
        "(weight_builds = 1)");
  }
  if (!study.scene->solved() && any_of_acstudy) {
    line(study.scene->sourceless() ? "a source: f = 0" : "source quadrature: f is given (quadrature_points = 0)");
  } else if (any([](const Series& s) { return !s.nonlocal_source; })) {
    line("source quadrature where the source is local: f = u_t + (c u)_x (quadrature_points = 0)");
  }
  for (const ModelCard* model : model_cards()) {
    if (model->left_out.empty() || !any([&](const Series& s) { return s.scheme.model == model; })) continue;
    line(fmt::format("{} in {}", model->left_out, model->name));
  }
  if (any([](const Series& s) { return s.cases.back().delta < s.cases.back().h && !s.scheme.model->beyond_paper; })) {
    std::vector<std::string> nearest;
    for (const ModelCard* model : model_cards()) {
      if (!model->beyond_paper) nearest.push_back(fmt::format("{} in {}", model->sides(), model->name));
    }
    line(fmt::format("neighbors beyond the nearest where the horizon is below the spacing: {}",
                     fmt::join(nearest, ", ")));
  }
  const auto one_stage = [](const Series& s) { return s.cases.front().integrator->stage_count() == 1; };
  if (any(one_stage)) line("stage storage where the integrator has one stage");
  return out.empty() ? "  - nothing\n" : out;
}

}  // namespace

namespace {

/// "about 0.12 s, 3.1 MB": of a processor, and of memory. Nothing is known of the seconds of a program.
std::string cost_text(double seconds, double bytes, bool of_acstudy) {
  return (of_acstudy ? fmt::format("about {}, ", seconds_text(seconds)) : "") + bytes_text(bytes);
}

std::string cost_text(const StudyForecast& forecast) {
  const auto& series = forecast.study->series;
  const bool of_acstudy =
      std::any_of(series.begin(), series.end(), [](const Series& s) { return s.scheme.program == nullptr; });
  return cost_text(forecast.seconds(), forecast.bytes(), of_acstudy);
}

/// A study that is judged by what it measures.
std::string explain_measurements(const StudyForecast& forecast) {
  const Study& study = *forecast.study;
  std::string out = fmt::format("{} - {} ({})\n\n", study.name, study.title, study.kind);
  std::size_t cases = 0;
  for (const Series& series : study.series) cases += series.cases.size();
  for (const Measurement& measurement : study.measurements) out += "  " + measurement.check.label() + "\n";
  return out + fmt::format("\n{} measurements, {} cases run for them{}\n", study.measurements.size(), cases,
                           cases == 0 ? "" : ": " + cost_text(forecast));
}

std::string solution(const SceneText& scene) {
  if (!scene.u0) return fmt::format("  u = {}\n", scene.u);
  return fmt::format("  u = {} at t = 0, not known later\n  f = {}\n", *scene.u0, scene.f.value_or("0"));
}

/// What errors are against where no solution is known, and how much of them is seen.
std::string explain_reference(const Series& series, const ReferenceLevel& reference) {
  const Case& finest = series.cases[series.levels() - 1];
  const double missing = std::pow(reference.variable / series.variable(finest.h, finest.delta), series.theory.order);
  std::string out = fmt::format("  reference: the run at N = {}", reference.N);
  if (series.theory.order > 0.0) {
    out += fmt::format("; to it the finest level has {:.0f} % of its error, which the judge makes up for",
                       100.0 * (1.0 - missing));
  }
  out += "\n";
  if (series.levels() < 4) out += "  fewer than four levels beside the reference: an order is hardly determined\n";
  return out;
}

/// A program, and the cases that it is told.
std::string explain_program(const Series& series) {
  const OutsideProgram& program = *series.scheme.program;
  std::string out = fmt::format("  command: {}\n  timeout: {:g} s\n", program.command_line(), program.timeout);
  for (const OutsideProgram::Input& input : program.inputs) {
    out += fmt::format("  input: {}, checksum {:016x}\n", input.file, input.checksum);
  }
  const bool steps = series.cases.front().steps > 0;
  out += fmt::format("  {:>9} {:>11} {:>11}{}\n", "N", "h", "delta",
                     steps ? fmt::format(" {:>11} {:>9}", "dt", "steps") : "");
  for (const Case& c : series.cases) {
    out += fmt::format("  {:>9} {:>11.4g} {:>11.4g}{}{}\n", c.N, c.h, c.delta,
                       steps ? fmt::format(" {:>11.4g} {:>9}", c.dt, c.steps) : "",
                       series.against_reference && &c == &series.cases.back() ? "  reference" : "");
  }
  return out;
}

/// The form that runs each case of a series, coarse to fine: "vector up to N = 640, vector with far sums up to N =
/// 2560".
std::string forms_of(std::span<const CaseForecast> cases) {
  std::string out;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Plan& plan = cases[i].plan;
    const bool last = i + 1 == cases.size();
    if (!last && cases[i + 1].plan.form == plan.form) continue;
    if (last && out.empty()) return std::string(plan.form->name);
    out += fmt::format("{}{} up to N = {}", out.empty() ? "" : ", ", plan.form->name, plan.c->N);
  }
  return out;
}

}  // namespace

std::string explain(const StudyForecast& forecast, std::span<const Finding> budgets) {
  const Study& study = *forecast.study;
  const auto of_series = [](const Measurement& measurement) { return measurement.check.series.has_value(); };
  if (!std::all_of(study.measurements.begin(), study.measurements.end(), of_series) || study.measurements.empty()) {
    return explain_measurements(forecast);
  }
  const SceneText& scene = study.scene->text();
  std::string out = fmt::format("{} - {}\n\n", study.name, study.title);
  out += fmt::format("scene {}: period {}, T = {}\n  c = {}\n  b = {}\n{}",
                     scene.name.empty() ? "(inline)" : scene.name, scene.period, scene.T, scene.c,
                     study.scene->standing() ? "0 (particles stand still)" : *scene.b, solution(scene));
  if (!study.scene->standing()) {
    out += fmt::format("  flow = {}\n", scene.flow ? *scene.flow : "integrated from x' = b(x) to round-off");
  }
  std::set<std::string> said;
  for (const Series& series : study.series) {
    const Case& c = series.cases.front();
    if (c.integrator == &own_steps && c.steps == 0) continue;
    const std::string stepping =
        fmt::format("time: {}, step {}{}{}\n", c.integrator->name, c.step.label(), c.step.adaptive() ? "" : " at most",
                    std::isinf(c.limit) ? "" : fmt::format("; a case is ended after {:g} s", c.limit));
    if (said.insert(stepping).second) out += stepping;
  }

  std::size_t count = 0;
  for (const Measurement& measurement : study.measurements) {
    const Series& series = study.series[*measurement.check.series];
    out += fmt::format("\n{}, source {}\n", measurement.check.label(),
                       series.against_reference ? "given"
                       : series.nonlocal_source ? "nonlocal"
                                                : "local");
    const Case& first = series.cases.front();
    if (first.start != Start{}) out += fmt::format("  start: {}\n", first.start.label());
    if (first.step.adaptive()) {
      out += "  dt: of the first step that is tried; steps: a guess\n";
    } else if (first.step.bound != StepRule::Bound::none) {
      out += fmt::format("  dt and steps: by the lemma at the start; while running, by the {} of the moment\n",
                         first.step.bound == StepRule::Bound::lemma ? "smallest gap" : "rows of the scheme");
    }
    if (series.nonlocal_source && series.scheme.program == nullptr)
      out += fmt::format("  source by {}\n", text(study.source_rule));
    if (series.theory.order > 0.0) {
      out += fmt::format("  theory: order {:g} in {} ({})\n", series.theory.order, series.theory.variable,
                         series.theory.statement);
    } else {
      out += fmt::format("  theory: the error does not vanish ({})\n", series.theory.statement);
    }
    if (const auto reference = series.reference_level()) out += explain_reference(series, *reference);
    count += series.cases.size();
    const SeriesForecast& ahead = forecast.series[*measurement.check.series];
    out += fmt::format("  the gate expects: {}\n  form: {}\n", name_of(series.expected), forms_of(ahead.cases));
    if (series.scheme.program == nullptr)
      out += fmt::format("  takes: {}\n", cost_text(ahead.seconds(), ahead.bytes(), true));
    if (series.until_decided) {
      out += fmt::format("  from N = {} on a level is added where the verdict is not decided without it\n",
                         series.cases[std::min(series.cases_at_first(), series.cases.size() - 1)].N);
    }
    if (series.scheme.program != nullptr) {
      out += explain_program(series);
      continue;
    }
    if (series.scheme.model->viscous) out += fmt::format("  mu = {:.6g}\n", series.cases.front().mu);
    out += fmt::format("  {:>9} {:>11} {:>11} {:>11} {:>9} {:>10} {:>6}\n", "N", "h", "delta", "dt", "steps",
                       "neighbors", "CFL");
    for (const Case& c : series.cases) {
      const double per_side = std::max(1.0, std::floor(c.delta / c.h * (1.0 + horizon_tie_tolerance)));
      out +=
          fmt::format("  {:>9} {:>11.4g} {:>11.4g} {:>11.4g} {:>9} {:>10} {:>#6.3g}{}{}\n", c.N, c.h, c.delta, c.dt,
                      c.steps, series.scheme.model->sides() * static_cast<std::int64_t>(per_side), c.cfl(),
                      c.cfl() > 1.0 && !c.integrator->implicit() && !c.step.adaptive()
                          ? series.scheme.model->step_lemma.promised ? "  beyond the bound 1 of the stability lemma"
                                                                     : "  beyond 1, where nothing is known of its steps"
                          : "",
                      series.against_reference && &c == &series.cases.back() ? "  reference" : "");
    }
    const ModelCard& model = *series.scheme.model;
    if (!model.step_lemma.enough_for_every_kernel && !vanishes_at_origin(series.scheme.kernel)) {
      out += fmt::format(
          "  the bound of {}, 1, is not enough for every kernel: see the section on {} of docs/equations.md\n",
          model.step_lemma.name, model.name);
    }
    if (series.scheme.mu && *series.scheme.mu < study.scene->max_relative_velocity()) {
      out += fmt::format("  mu is below max|c - b| = {:.6g}: {} does not promise stability\n",
                         study.scene->max_relative_velocity(), model.step_lemma.name);
    }
  }
  out += fmt::format(
      "\n{} series, {} cases: {}; neighbors of uniform particles, CFL at the start\n\nleft out, because nothing here "
      "needs it:\n{}",
      study.series.size(), count, cost_text(forecast), left_out(study));
  std::vector<std::string> warnings = lints(study);
  for (std::string& hidden : hidden_by_time(study, budgets)) warnings.push_back(std::move(hidden));
  if (!warnings.empty())
    out += fmt::format("\nwhat its solution cannot show:\n  - {}\n", fmt::join(warnings, "\n  - "));
  return out;
}

}  // namespace acstudy
