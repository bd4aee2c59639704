#include "studies/running/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <utility>

#include "studies/running/ensemble/shared_particles.hpp"
#include "studies/running/ensemble/sweep_group.hpp"

namespace acstudy {

namespace {

/// How far midpoints are from the middle of a vector of particles, at the start or at T.
double panel_reach(const Case& c) {
  std::vector<double> x = start_positions(c.start, static_cast<std::size_t>(c.N), c.scene->period());
  const double at_start = gaps(x, c.scene->period()).largest;
  Trajectories trajectories(*c.scene, x);
  const auto at_end = trajectories.at(c.scene->T());
  const double largest = std::max(at_start, gaps({at_end.begin(), at_end.end()}, c.scene->period()).largest);
  return midpoint_reach(c.delta, largest);
}

bool has_panels(const Case& c) {
  try {
    return VelocityPanels::find(*c.scene, panel_reach(c)).has_value();
  } catch (const std::domain_error&) {
    return false;  // the flow cannot be integrated, which the run itself comes to say
  }
}

/// What the sums over several particles at a time are not made for.
bool asks_for_readable(const Case& c) {
  return c.readable || c.scheme.program != nullptr || c.scheme.control != nullptr || !c.scheme.model->linear;
}

/// Velocities at midpoints, which symmetric sums on moving particles need, have to be short trigonometric series, or
/// smooth enough for polynomials on panels.
bool vector_takes(const Plan& plan) {
  const Case& c = *plan.c;
  if (asks_for_readable(c)) return false;
  if (c.scene->standing()) return true;
  switch (c.scheme.model->vector_form) {
    case VectorForm::none:
      return false;
    case VectorForm::upwind:
      return true;
    case VectorForm::symmetric:
      return plan.velocity->modes || has_panels(c);
  }
  return false;
}

bool far_pays(const Plan& plan, bool both) {
  return SweepGroup::far_pays(*plan.c, plan.velocity->modes.has_value(), both);
}

bool is_implicit(const Plan& plan) { return plan.c->integrator->implicit(); }

bool far_takes(const Plan& plan) {
  return !asks_for_readable(*plan.c) && !is_implicit(plan) && !plan.c->scene->standing() && far_pays(plan, false);
}

constexpr Form table[] = {
    {"command", [](const Plan& plan) { return plan.c->scheme.program != nullptr; }, false},
    {"vector with far sums", far_takes, true, true},
    {"vector with implicit steps", [](const Plan& plan) { return is_implicit(plan) && vector_takes(plan); }, true},
    {"vector", vector_takes, true},
    {"readable with implicit steps", is_implicit, false},
    {"readable", [](const Plan&) { return true; }, false}};

std::string pairs_of(const Case& c) {
  return fmt::format("{}|{}|{:.17g}|{:.17g}", c.scheme.model->number, c.scheme.kernel.label(), c.delta, c.mu);
}

/// What decides where particles are, and when.
std::string particles_of(const Case& c) {
  const SceneText& text = c.scene->text();
  std::string bound;
  if (c.step.bound == StepRule::Bound::lemma) bound = fmt::format("|{:.17g}", c.step.safety * c.lemma_bound(1.0));
  if (c.step.bound == StepRule::Bound::rows) bound = fmt::format("|rows|{:.17g}|{}", c.step.safety, pairs_of(c));
  return fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}{}|{}{:.17g}", text.period, text.T, text.c, text.b.value_or(""),
                     text.solution(), text.flow.value_or(""), c.integrator->name, c.N, c.steps, bound, c.start.label(),
                     c.start.smallest_gap);
}

/// The first form from `first` on that takes the case.
const Form* form_of(const Plan& plan, const Form* first) {
  return std::find_if(first, std::end(table), [&](const Form& form) { return form.takes(plan); });
}

/// Far sums pay later for two cases that share their sums.
void agree_on_forms(std::vector<Plan>& plans) {
  std::map<std::pair<std::string_view, std::string_view>, std::array<std::vector<Plan*>, 2>> by_divergence;
  for (Plan& plan : plans) {
    if (plan.form->far)
      by_divergence[{plan.particles, plan.pairs}][plan.c->scheme.nonlocal_divergence].push_back(&plan);
  }
  for (const auto& [key, cases] : by_divergence) {
    for (std::size_t i = 0; i < std::min(cases[0].size(), cases[1].size()); ++i) {
      for (Plan* const plan : {cases[0][i], cases[1][i]}) {
        if (!far_pays(*plan, true)) plan->form = form_of(*plan, plan->form + 1);
      }
    }
  }
}

}  // namespace

std::span<const Form> forms() { return table; }

std::vector<Plan> plan(std::span<const Case* const> cases) {
  std::map<const Scene*, std::shared_ptr<const VelocitySeries>> velocities;
  std::vector<Plan> plans;
  for (const Case* c : cases) {
    Plan& plan = plans.emplace_back(Plan{.c = c});
    if (!asks_for_readable(*c)) {
      auto& velocity = velocities[c->scene.get()];
      if (!velocity) velocity = std::make_shared<const VelocitySeries>(*c->scene);
      plan.velocity = velocity;
    }
    plan.form = form_of(plan, table);
    // Adaptive steps are of one case: no other has its particles at the same times.
    plan.particles = plan.form->together && !c->step.adaptive() ? particles_of(*c) : c->key();
    if (plan.form->together) plan.pairs = pairs_of(*c);
  }
  agree_on_forms(plans);
  return plans;
}

Plan plan(const Case& c) {
  const Case* const one = &c;
  return plan({&one, 1}).front();
}

}  // namespace acstudy
