#include "studies/reading/study_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "studies/models/control_choice.hpp"
#include "studies/models/outside_program.hpp"
#include "studies/models/theory.hpp"
#include "studies/reading/nearest.hpp"
#include "studies/reading/program_part.hpp"
#include "studies/reading/shared_tables.hpp"

namespace acstudy {

namespace {

/// reference, u0 and f of a scene whose solution is not known; true if it is one.
bool read_unsolved(const Table& table, SceneText& text, Solution solution) {
  const toml::node* const reference = table.find("reference");
  if (reference == nullptr) {
    for (const char* const key : {"u0", "f"}) {
      const toml::node* const node = table.find(key);
      if (node == nullptr) continue;
      table.place(*node).fail(fmt::format(
          "{} goes with reference = \"finest\", where no solution is known; u fixes it, so leave out one or the other",
          key));
    }
    return false;
  }
  const Place at = table.place(*reference);
  if (solution == Solution::needed) {
    at.fail("a study of this kind needs the exact solution; write u = \"cos(x-t)\" in place of reference, u0 and f");
  }
  table.choice<int>("reference", *reference, {{"finest", 0}});
  if (table.find("u") != nullptr) {
    at.fail("u gives the exact solution, and reference is for scenes without one; leave out one or the other");
  }
  std::size_t offset = 0;
  text.u0 = table.expression_text("u0", "u0 = \"cos(x)\", the values at t = 0", offset);
  if (table.find("f") != nullptr) text.f = table.expression_text("f", "f = \"sin(x-t)\"", offset);
  return true;
}

}  // namespace

std::shared_ptr<const Scene> read_scene(const Table& table, Solution solution) {
  SceneText text;
  const toml::node* named = table.find("use");
  if (named != nullptr) {
    table.allow({"use", "T"});
    const std::string name = table.text("use", "use = \"lee-du-2019\"");
    std::vector<std::string> known;
    for (const auto& scene : named_scenes()) known.push_back(scene.name);
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      table.place(*named).fail(fmt::format("unknown scene {}; known scenes: {}{}", in_quotes(name),
                                           fmt::join(known, ", "), did_you_mean(name, known)));
    }
    text = named_scenes()[found - known.begin()];
  }
  std::size_t offset = 0;
  if (named == nullptr) {
    if (table.find("c") == nullptr && table.find("u") == nullptr) {
      table.miss("[scene] names no scene and gives no fields; write use = \"lee-du-2019\", or period, T, c and u",
                 "use = \"lee-du-2019\"");
    }
    text.period = table.expression_text("period", "period = \"2*pi\"", offset);
    text.c = table.expression_text("c", "c = \"cos(2*x)/3\"", offset);
    if (!read_unsolved(table, text, solution)) {
      text.u = table.expression_text(
          "u", "u = \"cos(x-t)\", or reference = \"finest\" and u0 = \"cos(x)\" where no solution is known", offset);
    }
    if (table.find("b") != nullptr) text.b = table.expression_text("b", "b = \"sin(x)\"", offset);
    if (table.find("flow") != nullptr) text.flow = table.expression_text("flow", "flow = \"x + t\"", offset);
  }
  if (named == nullptr || table.find("T") != nullptr) text.T = table.expression_text("T", "T = 1", offset);
  try {
    return std::make_shared<const Scene>(text);
  } catch (const SceneError& error) {
    const toml::node* const node = table.find(error.field);
    if (node == nullptr) table.place().fail(error.what());
    const bool quoted = node->is_string();
    table.place(*node).shifted((quoted ? 1 : 0) + error.position).fail(error.what());
  }
}

std::shared_ptr<const Scene> read_scene_with_advection(const Table& table) {
  auto scene = read_scene(table);
  if (scene->max_relative_velocity() == 0.0) {
    table.place().fail("c - b is zero everywhere, so there is no operator to study; choose another c or b");
  }
  return scene;
}

const ModelCard& read_model(const Table& table) {
  const toml::node& node = table.need("model", "model = 1");
  const auto number = node.value_exact<std::int64_t>();
  const auto name = node.value_exact<std::string>();
  const ModelCard* const model = number ? find_model(*number) : name ? find_named_model(*name) : nullptr;
  if (model == nullptr || (number && model->beyond_paper)) {
    std::vector<std::string> known;
    for (const ModelCard* card : model_cards()) {
      if (!card->limiter.empty()) continue;
      known.push_back(card->beyond_paper ? in_quotes(card->name) : std::to_string(card->number));
    }
    table.place(node).fail(fmt::format("model = {}; it must be {}", Table::described(node), fmt::join(known, " or ")));
  }
  const toml::node* const limiter = table.find("limiter");
  if (limiter == nullptr) return *model;
  std::vector<std::string> limiters;
  for (const ModelCard* card : model_cards()) {
    if (card->name == model->name && !card->limiter.empty()) limiters.push_back(in_quotes(card->limiter));
  }
  if (limiters.empty()) table.place(*limiter).fail(fmt::format("{} has no limiter; leave limiter out", model->name));
  const auto text = limiter->value_exact<std::string>();
  const ModelCard* const limited = text ? find_named_model(model->name, *text) : nullptr;
  if (limited == nullptr || text->empty()) {
    table.place(*limiter).fail(
        fmt::format("limiter = {}; it must be {}", Table::described(*limiter), fmt::join(limiters, " or ")));
  }
  return *limited;
}

SchemeChoice read_scheme(const Table& table, const Scene& scene, Programs programs) {
  SchemeChoice scheme{};
  if (is_program(table)) {
    if (programs == Programs::refused) {
      table.place(*table.find("command"))
          .fail(
              "a study of this kind looks into the sums of its schemes, which a command keeps to itself; name it in "
              "a study of kind \"convergence\", and write model = 1 here");
    }
    scheme.model = &outside_model;
    scheme.program = read_program(table);
    return scheme;
  }
  for (const char* const key : program_keys) {
    if (const toml::node* const node = table.find(key)) {
      table.place(*node).fail(fmt::format("{} goes with command; leave it out", key));
    }
  }
  scheme.model = &read_model(table);
  const toml::node* const divergence = table.find("divergence");
  if (divergence != nullptr) {
    scheme.nonlocal_divergence = table.choice<bool>("divergence", *divergence, {{"local", false}, {"nonlocal", true}});
  } else if (!scene.standing()) {
    table.need("divergence", "divergence = \"local\"");
  }
  scheme.kernel = read_kernel(table, *scheme.model);
  if (const toml::node* const mu = table.find("mu")) {
    if (!scheme.model->viscous) {
      table.place(*mu).fail(fmt::format("{} has no viscosity; leave mu out", scheme.model->name));
    }
    scheme.mu = table.number("mu", *mu);
    if (*scheme.mu < 0.0) {
      table.place(*mu).fail(fmt::format("mu = {}; a viscosity bound must be finite and not negative", *scheme.mu));
    }
  }
  return scheme;
}

std::vector<SchemeEntry> read_schemes(const Table& root, const Scene& scene, Programs programs) {
  std::vector<SchemeEntry> entries;
  std::set<std::string> keys;
  double widest = -1.0;
  for (const Table& table : root.array_of_tables("scheme")) {
    const SchemeChoice scheme = read_scheme(table, scene, programs);
    if (scheme.model->viscous && !scheme.mu && widest < 0.0) widest = scene.max_relative_velocity();
    const double mu = scheme.model->viscous ? scheme.mu.value_or(widest) : 0.0;
    if (scheme.program != nullptr && !keys.insert(scheme.program->label).second) {
      table.place().fail(fmt::format("a second scheme with the label {}; labels must differ: write label = \"...\"",
                                     in_quotes(scheme.program->label)));
    }
    if (scheme.program == nullptr && !keys.insert(fmt::format("{}|{}|{}|{}", scheme.model->number,
                                                              scheme.nonlocal_divergence, scheme.kernel.label(), mu))
                                          .second) {
      table.place().fail("the same scheme a second time; leave one of them out");
    }
    entries.push_back({scheme, mu});
  }
  return entries;
}

std::vector<Subject> read_subjects(const Table& root, const std::shared_ptr<const Scene>& scene) {
  std::vector<Subject> subjects;
  for (const SchemeEntry& entry : read_schemes(root, *scene)) {
    for (const Arrangement arrangement : arrangements) {
      if (arrangement == Arrangement::moved && scene->standing()) continue;
      subjects.push_back({entry.scheme, entry.mu, scene, arrangement});
    }
  }
  return subjects;
}

std::vector<double> read_positive(const Table& table, std::string_view key, std::string_view example) {
  std::vector<double> values;
  for (const toml::node& item : table.list(key, example)) {
    values.push_back(table.number(key, item));
    if (values.back() <= 0.0) {
      table.place(item).fail(fmt::format("{} contains {}; every entry must be positive and finite: write {}", key,
                                         values.back(), example));
    }
  }
  return values;
}

SchemeEntry read_control(const Table& table, const Scene& scene) {
  const std::string name = table.text("name", "name = \"downwind\"");
  const Control* const control = find_control(name);
  if (control == nullptr) {
    std::vector<std::string> known;
    for (const Control& one : named_controls()) known.push_back(fmt::format("\"{}\"", one.name));
    table.place(*table.find("name"))
        .fail(fmt::format("name = {}; it must be one of {}", in_quotes(name), fmt::join(known, ", ")));
  }
  const Table inner = table.sub_table("scheme");
  inner.allow(scheme_keys);
  SchemeChoice scheme = read_scheme(inner, scene);
  if (scheme.nonlocal_divergence || (control->model != nullptr && control->model != scheme.model)) {
    const ModelCard& right = control->model != nullptr ? *control->model : *model_cards().front();
    inner.place().fail(fmt::format(
        "{} is a mistake in {}, local divergence; write scheme = {{ model = {}, divergence = \"local\", ... }}", name,
        control->model != nullptr ? right.name : "any model", right.number));
  }
  if (control->flow != nullptr && scene.text().b != control->flow_of_b) {
    table.place().fail(fmt::format("{} are those of b = {}; use the scene \"lee-du-2019\"", name, control->flow_of_b));
  }
  scheme.control = control;
  return {scheme, scheme.model->viscous ? scheme.mu.value_or(scene.max_relative_velocity()) : 0.0};
}

Resolutions read_resolutions(const Table& table, const Scene& scene, std::int64_t fewest) {
  Resolutions resolutions{read_levels(table), read_positive(table, "ratios", "ratios = [0.01, 0.5, 1, 4, 30]"), {}};
  const std::int64_t N = resolutions.N.front();
  if (N < fewest) {
    table.place(*table.find("N"))
        .fail(fmt::format(
            "N = {}; a study of this kind looks at horizons that are half the period or more with fewer than "
            "{} particles: leave it out",
            N, fewest));
  }
  if (resolutions.deltas(N, scene.period()).empty() && table.find("horizons") == nullptr) {
    table.place(*table.find("ratios"))
        .fail(fmt::format("none of these horizons stays below half the period at N = {}; write a ratio below {}", N,
                          0.5 * static_cast<double>(N)));
  }
  if (table.find("horizons") != nullptr) {
    resolutions.horizons = read_positive(table, "horizons", "horizons = [0.2]");
    for (const double delta : resolutions.horizons) {
      check_horizon(scene, resolutions.N.front(), delta, table.place(*table.find("horizons")));
    }
  }
  return resolutions;
}

namespace {

SourceRule read_source_rule(const Table& root) {
  if (root.find("source") == nullptr) return SourceRule::gauss;
  const Table source = root.sub_table("source");
  return source.choice<SourceRule>(
      "rule", source.need("rule", "rule = \"gauss\""),
      {{"gauss", SourceRule::gauss}, {"gsl", SourceRule::gsl}, {"boost", SourceRule::boost}});
}

}  // namespace

std::vector<Stepping> read_problem_with_steppings(const Table& root, Study& study, Solution solution) {
  study.scene = read_scene(root.sub_table("scene"), solution);
  study.source_rule = read_source_rule(root);
  const toml::node* const several = root.find("time");
  if (several == nullptr && programs_alone(root)) return {Stepping{.integrator = &own_steps}};
  return read_steppings(root);
}

Stepping read_problem(const Table& root, Study& study) {
  std::vector<Stepping> steppings = read_problem_with_steppings(root, study);
  if (steppings.size() > 1) {
    root.place(*root.find("time"))
        .fail("a study of this kind steps in one way; leave one [[time]], and one tolerance where steps are adaptive");
  }
  if (steppings.front().expect) {
    root.place(*root.find("time"))
        .fail("a study of this kind expects nothing of a way to step; leave expect out of it");
  }
  return std::move(steppings.front());
}

void check_horizon(const Scene& scene, std::int64_t N, double delta, const Place& at) {
  const double h = scene.period() / static_cast<double>(N);
  if (!std::isfinite(delta) || delta <= 0.0) {
    at.fail(
        fmt::format("delta = {:.6g} at h = {:.6g} (N = {}); a horizon must be positive and finite: write an expression "
                    "in h and N such as \"4*h\"",
                    delta, h, N));
  }
  if (delta >= 0.5 * scene.period()) {
    at.fail(
        fmt::format("delta = {:.6g} at h = {:.6g} (N = {}); a horizon must stay below half the period, {:.6g}, or a "
                    "particle would meet its own images",
                    delta, h, N, 0.5 * scene.period()));
  }
}

Case make_case(const Study& study, const Stepping& time, const SchemeEntry& entry, std::int64_t N, double delta,
               bool nonlocal_source, const Place& at, const Start& start) {
  const Scene& scene = *study.scene;
  check_horizon(scene, N, delta, at);
  if (nonlocal_source && entry.scheme.program == nullptr && entry.scheme.model->continuum == nullptr) {
    const ModelCard& model = *entry.scheme.model;
    at.fail(model.no_nonlocal_model.empty()
                ? fmt::format("no nonlocal model is known that {} goes to; write source = \"local\"", model.name)
                : fmt::format("{}; write source = \"local\"", model.no_nonlocal_model));
  }
  if (entry.scheme.program == nullptr && !entry.scheme.model->linear &&
      (time.integrator->implicit() || time.rule.bound == StepRule::Bound::rows)) {
    time.at_step.fail(fmt::format("{} is not linear, so that it has no matrix for {}; {}, or leave limiter out",
                                  entry.scheme.model->label(),
                                  time.integrator->implicit() ? "implicit steps" : "bound = \"rows\"",
                                  time.integrator->implicit() ? "take an explicit integrator" : "leave bound out"));
  }
  if (entry.scheme.model->carries_volumes && entry.scheme.nonlocal_divergence && !scene.standing() &&
      time.rule.adaptive()) {
    time.at_step.fail(
        fmt::format("with the nonlocal divergence the unknown of {} is V u, and a tolerance is one of u; write a step, "
                    "or divergence = \"local\"",
                    entry.scheme.model->label()));
  }
  Case c{.scene = study.scene,
         .scheme = entry.scheme,
         .mu = entry.mu,
         .nonlocal_source = nonlocal_source,
         .source_rule = study.source_rule,
         .integrator = time.integrator,
         .N = N,
         .h = scene.period() / static_cast<double>(N),
         .delta = delta,
         .dt = 0.0,
         .steps = 0,
         .start = start,
         .step = time.rule};
  if (entry.scheme.program != nullptr) {
    c.integrator = &own_steps;
    if (!time.step) {
      c.step = {.text = std::string(own_steps.name)};
      return c;
    }
  }
  set_steps(c, time);
  return c;
}

Series make_series(const Study& study, const Stepping& time, const SchemeEntry& entry, const PathChoice& path,
                   const Place& at_delta) {
  Series series{.scheme = entry.scheme,
                .path = path.name,
                .delta_text = path.delta.text(),
                .nonlocal_source = path.nonlocal_source,
                .theory = {},
                .expected = Verdict::confirmed,
                .cases = {}};
  series.stepping = time.label;
  series.until_decided = path.until_decided;
  series.against_reference = path.against_reference;
  for (const std::int64_t N : path.N) {
    const double period = study.scene->period(), gap = path.start.smallest_gap * period / static_cast<double>(N);
    if (period + gap == period) {
      path.at_start.fail(
          fmt::format("smallest_gap = {:g} is a gap of {:.3g} at N = {}, which positions near {:.3g} cannot "
                      "hold; write a larger one",
                      path.start.smallest_gap, gap, N, period));
    }
    const double count = static_cast<double>(N), delta = path.delta({study.scene->period() / count, count});
    series.cases.push_back(make_case(study, time, entry, N, delta, path.nonlocal_source, at_delta, path.start));
    series.cases.back().path = path.name;
  }
  const Case& finest = series.cases[series.levels() - 1];
  const bool fixed = finest.delta == series.cases.front().delta && series.cases.size() > 1;
  // The limit of the reference at a fixed horizon is the nonlocal model with its source.
  series.theory =
      entry.scheme.program != nullptr
          ? theory_of(*entry.scheme.program, path, fixed)
          : theory_for(entry.scheme, study.scene->standing(), path.nonlocal_source || (fixed && path.against_reference),
                       fixed, finest.delta < finest.h);
  if (path.order) {
    series.theory.order = *path.order;
    series.theory.statement = "given by the study";
  }
  series.expected = time.expect
                        ? *time.expect
                        : path.expect.value_or(series.theory.order == 0.0 ? Verdict::stagnates : Verdict::confirmed);
  if (entry.scheme.program != nullptr && entry.scheme.program->expect) series.expected = *entry.scheme.program->expect;
  return series;
}

}  // namespace acstudy
