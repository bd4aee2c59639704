#include "studies/reading/time_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "solver/time/steps.hpp"
#include "studies/reading/path_part.hpp"

namespace acstudy {

namespace {

/// Fails where a key is there.
void refuse(const Table& table, std::initializer_list<const char*> keys, const char* goes_with) {
  for (const char* const key : keys) {
    if (const toml::node* const node = table.find(key)) {
      table.place(*node).fail(fmt::format("{} goes with {}; leave it out", key, goes_with));
    }
  }
}

/// One for each tolerance.
std::vector<Stepping> read_adaptive(const Table& time, const Stepping& stepping) {
  constexpr const char* example = "tolerance = 1e-4";
  if (!stepping.integrator->estimates()) {
    std::vector<std::string> known;
    for (const Integrator& one : integrators) {
      if (one.estimates()) known.push_back(fmt::format("\"{}\"", one.name));
    }
    stepping.at_step.fail(
        fmt::format("step = \"adaptive\", but {} has no estimate of its error; take one of the integrators {}",
                    stepping.integrator->name, fmt::join(known, ", ")));
  }
  const toml::node& node = time.need("tolerance", example);
  std::vector<const toml::node*> items = {&node};
  if (node.is_array()) {
    items.clear();
    for (const toml::node& item : time.list("tolerance", "tolerance = [1e-2, 1e-3]")) items.push_back(&item);
  }
  std::vector<Stepping> steppings;
  for (const toml::node* const item : items) {
    Stepping& one = steppings.emplace_back(stepping);
    one.tolerance = time.expression("tolerance", *item, example, {"h", "N"});
    one.at_tolerance = time.place(*item);
    one.rule = {
        .bound = StepRule::Bound::tolerance,
        .text = item->is_number() ? fmt::format("{:g}", time.number("tolerance", *item)) : one.tolerance->text()};
    if (const toml::node* const first = time.find("first")) {
      one.first = time.expression("first", "first = \"h\"", {"h", "N"});
      one.at_first = time.place(*first);
    }
  }
  return steppings;
}

/// [time], or one of [[time]]: several ways to step where it has several tolerances.
std::vector<Stepping> read_time(const Table& time) {
  std::vector<std::pair<std::string, const Integrator*>> words;
  for (const Integrator& integrator : integrators) words.emplace_back(integrator.name, &integrator);
  Stepping stepping{
      .integrator = time.choice("integrator", time.need("integrator", "integrator = \"forward-euler\""), words),
      .rule = {},
      .step = std::nullopt,
      .at_step = time.place(time.need("step", "step = \"h/4\""))};
  if (const toml::node* const limit = time.find("limit")) stepping.limit = time.seconds("limit", *limit);
  if (const toml::node* const expect = time.find("expect")) stepping.expect = read_expected(time, *expect);
  const auto step = time.find("step")->value_exact<std::string>();
  if (step != "cfl") refuse(time, {"safety", "bound"}, "step = \"cfl\"");
  if (step == "adaptive") return read_adaptive(time, stepping);
  refuse(time, {"tolerance", "first"}, "step = \"adaptive\"");
  StepRule& rule = stepping.rule;
  if (step == "cfl") {
    rule = {.bound = StepRule::Bound::lemma, .safety = 0.9, .text = "cfl"};
    if (const toml::node* const safety = time.find("safety")) {
      rule.safety = time.number("safety", *safety);
      if (rule.safety <= 0.0) {
        time.place(*safety).fail(fmt::format(
            "safety = {}; the fraction of the bound must be positive and finite: write safety = 0.9", rule.safety));
      }
    }
    if (const toml::node* const bound = time.find("bound")) {
      rule.bound = time.choice<StepRule::Bound>("bound", *bound,
                                                {{"lemma", StepRule::Bound::lemma}, {"rows", StepRule::Bound::rows}});
    }
    return {stepping};
  }
  stepping.step = time.expression("step", "step = \"h/4\"", {"h", "N"});
  rule.text = stepping.step->text();
  return {stepping};
}

}  // namespace

std::vector<Stepping> read_steppings(const Table& root) {
  const toml::node* const several = root.find("time");
  const bool one = several == nullptr || !several->is_array();
  const std::vector<Table> tables = one ? std::vector{root.sub_table("time")} : root.array_of_tables("time");
  std::vector<Stepping> steppings;
  std::set<std::string> labels;
  for (const Table& table : tables) {
    for (Stepping& stepping : read_time(table)) {
      stepping.label = fmt::format("{}, {}{}", stepping.integrator->name, stepping.rule.adaptive() ? "" : "step ",
                                   stepping.rule.label());
      if (!labels.insert(stepping.label).second) {
        table.place().fail("the same integrator and steps a second time; leave one of them out");
      }
      steppings.push_back(std::move(stepping));
    }
  }
  if (steppings.size() == 1) steppings.front().label.clear();
  return steppings;
}

namespace {

/// The value of a key at the level of the case, positive and finite.
double positive(const Case& c, const Expression& expression, const Place& place, const char* key, const char* what,
                const char* example) {
  const double value = expression({c.h, static_cast<double>(c.N)});
  if (!std::isfinite(value) || value <= 0.0) {
    place.fail(
        fmt::format("{} = {:.6g} at h = {:.6g} (N = {}); {} must be positive and finite: write an expression "
                    "in h and N such as \"{}\"",
                    key, value, c.h, c.N, what, example));
  }
  return value;
}

void set_adaptive_steps(Case& c, const Stepping& time) {
  const double T = c.scene->T();
  const double tolerance = positive(c, *time.tolerance, time.at_tolerance, "tolerance", "a tolerance", "1e-2*h^2");
  constexpr double least = 1e-13;
  if (tolerance < least) {
    time.at_tolerance.fail(
        fmt::format("tolerance = {:.6g} at h = {:.6g} (N = {}); round-off alone comes close to that: the least is {:g}",
                    tolerance, c.h, c.N, least));
  }
  c.step.tolerance = tolerance;
  c.dt = std::min(time.first ? positive(c, *time.first, time.at_first, "first", "a time step", "h") : c.h, T);
  // As if u were of size 1 and changed in times of 1, and stability limited explicit steps as the lemma does.
  const double accurate = std::pow(tolerance, 1.0 / c.integrator->order);
  const double stable = c.lemma_bound(c.delta < c.h ? c.h * c.start.smallest_gap : c.h);
  c.steps = steps_for(T, c.integrator->implicit() ? accurate : std::min(accurate, stable));
}

}  // namespace

void set_steps(Case& c, const Stepping& time) {
  if (c.scheme.program == nullptr) c.limit = time.limit;
  if (time.tolerance) return set_adaptive_steps(c, time);
  const double T = c.scene->T();
  const double bound = time.step ? positive(c, *time.step, time.at_step, "step", "a time step", "h/4")
                                 : time.rule.safety * c.lemma_bound(c.h * c.start.smallest_gap);
  if (!time.step && std::isinf(bound)) {
    time.at_step.fail(
        fmt::format("step = \"cfl\" where {} is zero, so that no bound limits a step; write an expression "
                    "in h and N such as \"h/4\"",
                    c.scheme.model->step_lemma.limit));
  }
  if (T / bound > 1e12) {
    time.at_step.fail(fmt::format("step = {:.6g} at h = {:.6g} (N = {}) asks for {:.3g} steps; the most is 1e12", bound,
                                  c.h, c.N, T / bound));
  }
  c.steps = steps_for(T, bound);
  c.dt = c.steps == 0 ? 0.0 : T / static_cast<double>(c.steps);
}

}  // namespace acstudy
