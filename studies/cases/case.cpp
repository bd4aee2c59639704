#include "studies/cases/case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/models/control_choice.hpp"
#include "studies/models/outside_program.hpp"

namespace acstudy {

std::string Case::key() const {
  const SceneText& text = scene->text();
  return fmt::format(
      "period={}|T={}|c={}|b={}|u={}|flow={}|model={}|divergence={}|kernel={}|alpha={:.17g}|mu={:.17g}|source={}|rule={"
      "}|"
      "integrator={}|N={}|delta={:.17g}|steps={}{}{}{}{}{}",
      text.period, text.T, text.c, text.b.value_or(""), text.solution(), text.flow.value_or(""),
      scheme.model->fingerprint != nullptr ? fmt::format("{}#{:016x}", scheme.model->name, scheme.model->fingerprint())
                                           : std::to_string(scheme.model->number),
      scene->standing()            ? "none"
      : scheme.nonlocal_divergence ? "nonlocal"
                                   : "local",
      scheme.kernel.name, scheme.kernel.parameter, mu, nonlocal_source ? "nonlocal" : "local",
      static_cast<int>(nonlocal_source ? source_rule : SourceRule::gauss), integrator->name, N, delta,
      step.bound == StepRule::Bound::none ? std::to_string(steps)
      : step.adaptive()                   ? fmt::format("adaptive,{:.17g},{:.17g}", step.tolerance, dt)
                                          : fmt::format("{}*{:.17g}", step.label(), step.safety),
      start == Start{} ? "" : fmt::format("|start={},{:.17g}", start.label(), start.smallest_gap),
      scheme.control == nullptr ? "" : fmt::format("|control={}", scheme.control->name),
      source_refinement == 1 ? "" : fmt::format("|source_points=x{}", source_refinement),
      readable ? "|form=readable" : "",
      scheme.program == nullptr ? "" : fmt::format("|path={}|program={}", path, scheme.program->key()));
}

double Case::estimated_work() const {
  // Nothing is known of a program but that it has to start, and that fine cases take longer.
  if (scheme.program != nullptr) return 1e7 + 100.0 * static_cast<double>(N) * static_cast<double>(N);
  constexpr double of_particle = 10.0, of_step = 2000.0;
  const bool by_rows = step.bound == StepRule::Bound::rows;
  // The rows allow about the steps of particles that no pair of which is close.
  const double taken = std::max(1.0, static_cast<double>(steps) * (by_rows ? start.smallest_gap : 1.0));
  const double of_stage =
      of_step + static_cast<double>(N) * (scheme.model->pair_cost * std::max(1.0, delta / h) + of_particle);
  const double dearer = readable ? 10.0 : integrator->implicit() ? 7.0 : by_rows ? 2.0 : 1.0;
  return dearer * taken * static_cast<double>(integrator->stage_count()) * of_stage;
}

double Case::result_bytes() const {
  constexpr double fields = 3.0;  // x, u and the exact one
  return fields * sizeof(double) * static_cast<double>(N);
}

double Case::working_bytes() const {
  constexpr double program = 3e7;                 // itself, with its libraries
  if (scheme.program != nullptr) return program;  // what another one needs is its own affair
  const double count = static_cast<double>(N), reach = std::min(std::max(1.0, delta / h), 0.5 * count);
  // Of a particle: always, besides where sums are taken one by one, and for a periodic band and its factors.
  double numbers = 16.0;
  if (readable || scheme.control != nullptr) numbers += 8.0 * reach;
  if (integrator->implicit()) numbers += 30.0 + 14.0 * reach;
  return program + sizeof(double) * numbers * count;
}

double Case::lemma_bound(double h_min) const { return h_min / scheme.model->step_lemma.speed(*scene, mu); }

void Case::halve_steps() {
  steps *= 2;
  dt *= 0.5;
  step.safety *= 0.5;
}

std::string StepRule::label() const {
  if (adaptive()) return fmt::format("adaptive to {}", text);
  return bound == Bound::none ? text : fmt::format("{:g} {}{}", safety, text, bound == Bound::rows ? " by rows" : "");
}

}  // namespace acstudy
