#include "studies/claims/extreme_rows.hpp"

#include <algorithm>
#include <atomic>
#include <set>
#include <stdexcept>

#include "solver/time/integrate.hpp"
#include "studies/claims/stability.hpp"
#include "studies/models/control_choice.hpp"

namespace acstudy {

void ExtremeRows::add(Check check, std::function<void(Finding&)> measure) {
  measurements_.emplace_back(std::move(check), std::move(measure));
}

void ExtremeRows::add_control(Check check, const std::string& why, std::function<void(Finding&)> measure,
                              Verdict expected) {
  if (!controls_.insert(check.claim + check.label()).second) return;
  check.be_control(why, expected);
  add(std::move(check), std::move(measure));
}

std::vector<Measurement> extreme_rows(const Extremes& extremes) {
  ExtremeRows rows;
  add_rows_of_resolution(rows, extremes);
  add_rows_of_velocity(rows, extremes);
  add_rows_of_positions(rows, extremes);
  add_rows_of_amplitude(rows, extremes);
  add_rows_of_time(rows, extremes);
  add_rows_of_shapes(rows, extremes);
  add_rows_of_mass(rows, extremes);
  return rows.take();
}

std::shared_ptr<const Scene> scene_with(const std::string& c, const std::optional<std::string>& b,
                                        const std::string& u) {
  return std::make_shared<const Scene>(
      SceneText{.name = "", .period = "1", .T = "1", .c = c, .b = b, .u = u, .flow = std::nullopt});
}

std::shared_ptr<const Scene> scene_named(std::string_view name) {
  for (const SceneText& text : named_scenes()) {
    if (text.name == name) return std::make_shared<const Scene>(text);
  }
  throw std::logic_error("no scene is named " + std::string(name));
}

Subject subject_on(const SchemeChoice& scheme, const std::shared_ptr<const Scene>& scene, Arrangement arrangement) {
  return {scheme, scheme.model->viscous ? scene->max_relative_velocity() : 0.0, scene, arrangement};
}

std::optional<Subject> mistaken(Subject subject, std::string_view control) {
  if (control.empty()) return std::nullopt;
  subject.scheme.control = find_control(control);
  subject.scheme.nonlocal_divergence = false;
  return subject;
}

std::vector<SchemeChoice> standing_schemes(const Extremes& extremes) {
  std::vector<SchemeChoice> standing;
  std::set<std::string> labels;
  for (SchemeChoice scheme : extremes.schemes) {
    scheme.nonlocal_divergence = false;
    if (labels.insert(scheme_label(scheme, true)).second) standing.push_back(scheme);
  }
  return standing;
}

double step_at_cfl_one(Subject subject, const std::vector<double>& x, double delta) {
  subject.scheme.control = nullptr;
  PlacedScheme placed(subject.scheme, *subject.scene, subject.mu, x, delta);
  return largest_step(subject, placed, StepCondition::corrected);
}

State run_freely(const Subject& subject, State start, double delta, double T, std::int64_t steps, const Seen& seen) {
  const Scene& scene = *subject.scene;
  const std::size_t count = start.x.size();
  const std::unique_ptr<LineScheme> scheme = make_scheme(subject.scheme, scene, subject.mu);
  Particles particles(count, scene.period(), delta);
  std::optional<Trajectories> trajectories;
  if (!scene.standing()) trajectories.emplace(scene, start.x);
  PeriodicArray u(count);
  std::copy(start.u.begin(), start.u.end(), u.values().begin());

  double placed_at = 0.0;
  const auto place = [&](std::span<const double> x) {
    particles.place(x);
    scheme->place(particles);
  };
  const auto rate = [&](double t, PeriodicArray& values, std::span<double> du) {
    if (trajectories && t != placed_at) place(trajectories->at(t));
    placed_at = t;
    scheme->rate(values, du);
  };
  const auto keep_going = [&](std::int64_t, const TimeStep& step) {
    if (seen) seen(step, trajectories ? trajectories->at(step.end) : particles.x.values(), u.values());
    return true;
  };
  place(start.x);
  integrate(integrators[0], u, EqualSteps(T, steps), ExplicitSystem{rate}, keep_going);
  if (trajectories) {
    const auto x = trajectories->at(T);
    start.x.assign(x.begin(), x.end());
  }
  start.u.assign(u.values().begin(), u.values().end());
  return start;
}

Case case_of(const Subject& subject, std::int64_t N, double delta, std::int64_t steps, std::string_view integrator) {
  const Scene& scene = *subject.scene;
  return {.scene = subject.scene,
          .scheme = subject.scheme,
          .mu = subject.mu,
          .nonlocal_source = false,
          .source_rule = SourceRule::gauss,
          .integrator = std::find_if(std::begin(integrators), std::end(integrators),
                                     [&](const Integrator& known) { return known.name == integrator; }),
          .N = N,
          .h = scene.period() / static_cast<double>(N),
          .delta = delta,
          .dt = steps == 0 ? 0.0 : scene.T() / static_cast<double>(steps),
          .steps = steps};
}

CaseResult run(const Case& c) {
  const std::atomic<bool> stop = false;
  CaseResult result = run_case(c, stop);
  if (!result.failure.empty()) throw std::runtime_error(result.failure);
  return result;
}

double excursion(std::span<const double> values, double smallest, double largest) {
  double farthest = -std::numeric_limits<double>::infinity();
  for (const double value : values) {
    const double out = std::isnan(value) ? value : std::max(value - largest, smallest - value);
    if (worse(out, farthest)) farthest = out;
  }
  return farthest;
}

std::vector<double> uneven_values(std::size_t count) {
  std::vector<double> values;
  for (std::size_t j = 0; j < count; ++j) values.push_back(static_cast<double>(j * 7 % 16 % count) / 15.0);
  values.front() = 0.0;
  values[count / 2] = 1.0;
  return values;
}

}  // namespace acstudy
