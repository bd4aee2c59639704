#include "studies/study_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "studies/control_choice.hpp"
#include "studies/theory.hpp"

namespace acstudy {

std::shared_ptr<const Scene> read_scene(const Table& table) {
  SceneText text;
  const toml::node* named = table.find("use");
  if (named != nullptr) {
    table.allow({"use", "T"});
    const std::string name = table.text("use", "use = \"lee-du-2019\"");
    std::vector<std::string> known;
    for (const auto& scene : named_scenes()) known.push_back(scene.name);
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      table.place(*named).fail(
          fmt::format("unknown scene {}; known scenes: {}", in_quotes(name), fmt::join(known, ", ")));
    }
    text = named_scenes()[found - known.begin()];
  } else {
    table.allow({"use", "period", "T", "c", "b", "u", "flow"});
  }
  std::size_t offset = 0;
  if (named == nullptr) {
    if (table.find("c") == nullptr && table.find("u") == nullptr) {
      table.place().fail(
          "[scene] names no scene and gives no fields; write use = \"lee-du-2019\", or period, T, c and u");
    }
    text.period = table.expression_text("period", "period = \"2*pi\"", offset);
    text.c = table.expression_text("c", "c = \"cos(2*x)/3\"", offset);
    text.u = table.expression_text("u", "u = \"cos(x-t)\"", offset);
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

int read_model(const Table& table) {
  const toml::node& model = table.need("model", "model = 1");
  const auto number = model.value_exact<std::int64_t>();
  if (!number || (*number != 1 && *number != 2)) {
    table.place(model).fail(fmt::format("model = {}; it must be 1 or 2", Table::described(model)));
  }
  return static_cast<int>(*number);
}

KernelChoice read_kernel(const Table& scheme, int model) {
  const toml::node& node = scheme.need("kernel", "kernel = \"cubic-spline\"");
  static const toml::table no_table;
  const toml::table* const table = node.as_table();
  const Table inner(table != nullptr ? *table : no_table, "kernel", scheme.file());
  const toml::node* name_node = &node;
  if (table != nullptr) {
    inner.allow({"name", "alpha"});
    name_node = &inner.need("name", "{ name = \"power\", alpha = 0.5 }");
  }
  KernelChoice kernel{scheme.text("kernel", *name_node, "kernel = \"inverse\"")};
  std::vector<std::string_view> known;
  for (const NamedKernel& named : named_kernels) known.push_back(named.name);
  if (std::find(known.begin(), known.end(), kernel.name) == known.end()) {
    scheme.place(*name_node)
        .fail(fmt::format("unknown kernel {}; known kernels: {}", in_quotes(kernel.name), fmt::join(known, ", ")));
  }

  const toml::node* const alpha = table != nullptr ? inner.find("alpha") : nullptr;
  if (alpha != nullptr) {
    if (kernel.name != "power") {
      inner.place(*alpha).fail(fmt::format("the {} kernel has no alpha; leave it out", kernel.name));
    }
    kernel.alpha = inner.number("alpha", *alpha);
    if (kernel.alpha >= 2.0) {
      inner.place(*alpha).fail(
          fmt::format("alpha = {}; the power kernel has a first moment only for a finite alpha < 2", kernel.alpha));
    }
    if (model == 2 && !integrable(kernel)) {
      inner.place(*alpha).fail(fmt::format("alpha = {}; Model II needs an integrable kernel: alpha < 1", kernel.alpha));
    }
  } else if (kernel.name == "power" && table != nullptr) {
    inner.place().fail("the power kernel has no alpha; write { name = \"power\", alpha = 0.5 }");
  } else if (kernel.name == "power") {
    scheme.place(node).fail("the power kernel needs its exponent; write { name = \"power\", alpha = 0.5 }");
  }
  if (model == 2 && !integrable(kernel)) {
    scheme.place(*name_node)
        .fail(fmt::format("Model II needs an integrable kernel, and the {} kernel is not; write \"cubic-spline\" or "
                          "{{ name = \"power\", alpha = 0.5 }} with alpha < 1",
                          kernel.name));
  }
  return kernel;
}

SchemeChoice read_scheme(const Table& table, const Scene& scene) {
  table.allow({"model", "divergence", "kernel", "mu"});
  SchemeChoice scheme{};
  scheme.model = read_model(table);
  const toml::node* const divergence = table.find("divergence");
  if (divergence != nullptr) {
    scheme.nonlocal_divergence = table.choice<bool>("divergence", *divergence, {{"local", false}, {"nonlocal", true}});
  } else if (!scene.standing()) {
    table.need("divergence", "divergence = \"local\"");
  }
  scheme.kernel = read_kernel(table, scheme.model);
  if (const toml::node* const mu = table.find("mu")) {
    if (scheme.model == 1) table.place(*mu).fail("Model I has no viscosity; leave mu out");
    scheme.mu = table.number("mu", *mu);
    if (*scheme.mu < 0.0) {
      table.place(*mu).fail(fmt::format("mu = {}; a viscosity bound must be finite and not negative", *scheme.mu));
    }
  }
  return scheme;
}

std::vector<SchemeEntry> read_schemes(const Table& root, const Scene& scene) {
  std::vector<SchemeEntry> entries;
  std::set<std::string> keys;
  double widest = -1.0;
  for (const Table& table : root.array_of_tables("scheme")) {
    const SchemeChoice scheme = read_scheme(table, scene);
    if (scheme.model == 2 && !scheme.mu && widest < 0.0) widest = scene.max_relative_velocity();
    const double mu = scheme.model == 1 ? 0.0 : scheme.mu.value_or(widest);
    if (!keys.insert(fmt::format("{}|{}|{}|{}", scheme.model, scheme.nonlocal_divergence, scheme.kernel.label(), mu))
             .second) {
      table.place().fail("the same scheme a second time; leave one of them out");
    }
    entries.push_back({scheme, mu});
  }
  return entries;
}

std::vector<std::int64_t> read_levels(const Table& table) {
  const toml::node& node = table.need("N", "N = [160, 320, 640, 1280]");
  const toml::array* const array = node.as_array();
  if (array == nullptr || array->empty()) {
    table.place(node).fail(fmt::format("N must be a list of particle numbers, not {}; write N = [160, 320, 640, 1280]",
                                       array == nullptr ? Table::described(node) : "an empty list"));
  }
  std::vector<std::int64_t> N;
  for (const toml::node& item : *array) {
    const auto value = item.value_exact<std::int64_t>();
    if (!value)
      table.place(item).fail(fmt::format("N contains {}; every entry must be a whole number", Table::described(item)));
    if (*value < 3)
      table.place(item).fail(fmt::format("N = {}; a periodic interval needs at least 3 particles", *value));
    if (*value > 100'000'000) table.place(item).fail(fmt::format("N = {}; the most is 100000000", *value));
    if (!N.empty() && *value <= N.back()) {
      table.place(item).fail(fmt::format("N = {} after {}; levels must go from coarse to fine", *value, N.back()));
    }
    N.push_back(*value);
  }
  return N;
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
  const auto control = std::find_if(named_controls.begin(), named_controls.end(),
                                    [&](const NamedControl& known) { return known.name == name; });
  if (control == named_controls.end()) {
    std::vector<std::string> known;
    for (const NamedControl& one : named_controls) known.push_back("\"" + std::string(one.name) + "\"");
    table.place(*table.find("name"))
        .fail(fmt::format("name = {}; it must be one of {}", in_quotes(name), fmt::join(known, ", ")));
  }
  const Table scheme_table = table.sub_table("scheme");
  SchemeChoice scheme = read_scheme(scheme_table, scene);
  if (scheme.nonlocal_divergence || (control->model != 0 && control->model != scheme.model)) {
    scheme_table.place().fail(fmt::format(
        "{} is a mistake in Model {}, local divergence; write scheme = {{ model = {}, divergence = \"local\", ... }}",
        name, control->model == 0 ? "I or II" : (control->model == 1 ? "I" : "II"), std::max(control->model, 1)));
  }
  if (name == misprinted_trajectories && scene.text().b != "sin(x)") {
    table.place().fail(fmt::format("{} are those of b = sin(x); use the scene \"lee-du-2019\"", name));
  }
  scheme.control = name;
  return {scheme, scheme.model == 1 ? 0.0 : scheme.mu.value_or(scene.max_relative_velocity())};
}

Sweep read_sweep(const Table& table, const Scene& scene) {
  table.allow({"N", "ratios", "horizons"});
  Sweep sweep{read_levels(table), read_positive(table, "ratios", "ratios = [0.01, 0.5, 1, 4, 30]"), {}};
  if (table.find("horizons") != nullptr) {
    sweep.horizons = read_positive(table, "horizons", "horizons = [0.2]");
    for (const double delta : sweep.horizons) {
      check_horizon(scene, sweep.N.front(), delta, table.place(*table.find("horizons")));
    }
  }
  return sweep;
}

Verdict read_expected(const Table& table, const toml::node& node) {
  std::vector<std::pair<std::string, Verdict>> words;
  for (int v = 0; v <= static_cast<int>(Verdict::inconclusive); ++v) {
    words.emplace_back(name_of(static_cast<Verdict>(v)), static_cast<Verdict>(v));
  }
  words.emplace_back(name_of(Verdict::stable), Verdict::stable);
  return table.choice<Verdict>("expect", node, words);
}

namespace {

/// start = "uniform", or { name = "jittered", smallest_gap = 0.01, seed = 1 }, { name = "clustered", ... }.
Start read_start(const Table& path, const toml::node& node) {
  static const toml::table no_table;
  const toml::table* const table = node.as_table();
  const Table inner(table != nullptr ? *table : no_table, "start", path.file());
  const char* const example = "{ name = \"jittered\", smallest_gap = 0.01, seed = 1 }";
  const toml::node& name = table != nullptr ? inner.need("name", example) : node;
  Start start{.kind = path.choice<Start::Kind>("start", name,
                                               {{"uniform", Start::Kind::uniform},
                                                {"jittered", Start::Kind::jittered},
                                                {"clustered", Start::Kind::clustered}})};
  switch (start.kind) {
    case Start::Kind::uniform:
      if (table != nullptr) inner.allow({"name"});
      return start;
    case Start::Kind::jittered:
      inner.allow({"name", "smallest_gap", "seed"});
      break;
    case Start::Kind::clustered:
      inner.allow({"name", "smallest_gap"});
      break;
  }
  if (table == nullptr) path.place(node).fail(fmt::format("this start needs its smallest gap; write {}", example));
  const toml::node& gap = inner.need("smallest_gap", example);
  start.smallest_gap = inner.number("smallest_gap", gap);
  if (!(start.smallest_gap > 0.0 && start.smallest_gap < 1.0)) {
    inner.place(gap).fail(
        fmt::format("smallest_gap = {}; in units of h it lies between 0 and 1: write {}", start.smallest_gap, example));
  }
  if (const toml::node* const seed = inner.find("seed")) {
    start.seed = static_cast<unsigned>(inner.whole("seed", *seed, 0, 1'000'000'000));
  }
  return start;
}

}  // namespace

PathChoice read_path(const Table& table) {
  table.allow({"name", "delta", "N", "source", "expect", "order", "start"});
  const toml::node& name = table.need("name", "name = \"delta = 4h\"");
  PathChoice path{.name = table.text("name", name, "name = \"delta = 4h\""),
                  .delta = table.expression("delta", "delta = \"4*h\"", {"h", "N"}),
                  .N = read_levels(table),
                  .nonlocal_source = table.choice<bool>("source", table.need("source", "source = \"local\""),
                                                        {{"local", false}, {"nonlocal", true}}),
                  .expect = std::nullopt,
                  .order = std::nullopt};
  if (path.name.empty()) table.place(name).fail("a path needs a name, for example \"delta = 4h\"");
  if (const toml::node* const expect = table.find("expect")) {
    path.expect = read_expected(table, *expect);
  }
  if (const toml::node* const start = table.find("start")) {
    path.start = read_start(table, *start);
    path.at_start = table.place(*start);
  }
  if (const toml::node* const order = table.find("order")) {
    path.order = table.number("order", *order);
    if (*path.order < 0.0) {
      table.place(*order).fail(fmt::format("order = {}; an order must be finite and not negative", *path.order));
    }
  }
  return path;
}

namespace {

Stepping read_time(const Table& time) {
  time.allow({"integrator", "step", "safety", "bound", "expect"});
  std::vector<std::pair<std::string, const Integrator*>> words;
  for (const Integrator& integrator : integrators) words.emplace_back(integrator.name, &integrator);
  Stepping stepping{
      .integrator = time.choice("integrator", time.need("integrator", "integrator = \"forward-euler\""), words),
      .rule = {},
      .step = std::nullopt,
      .at_step = time.place(time.need("step", "step = \"h/4\""))};
  if (const toml::node* const expect = time.find("expect")) stepping.expect = read_expected(time, *expect);
  StepRule& rule = stepping.rule;
  if (time.find("step")->value_exact<std::string>() == "cfl") {
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
    return stepping;
  }
  for (const char* const key : {"safety", "bound"}) {
    if (const toml::node* const node = time.find(key)) {
      time.place(*node).fail(fmt::format("{} goes with step = \"cfl\"; leave it out", key));
    }
  }
  stepping.step = time.expression("step", "step = \"h/4\"", {"h", "N"});
  rule.text = stepping.step->text();
  return stepping;
}

SourceRule read_source_rule(const Table& root) {
  if (root.find("source") == nullptr) return SourceRule::gauss;
  const Table source = root.sub_table("source");
  source.allow({"rule"});
  return source.choice<SourceRule>(
      "rule", source.need("rule", "rule = \"gauss\""),
      {{"gauss", SourceRule::gauss}, {"gsl", SourceRule::gsl}, {"boost", SourceRule::boost}});
}

}  // namespace

std::vector<Stepping> read_problem_with_steppings(const Table& root, Study& study) {
  study.scene = read_scene(root.sub_table("scene"));
  study.source_rule = read_source_rule(root);
  const toml::node* const several = root.find("time");
  if (several == nullptr || !several->is_array()) return {read_time(root.sub_table("time"))};

  std::vector<Stepping> steppings;
  std::set<std::string> labels;
  for (const Table& table : root.array_of_tables("time")) {
    Stepping& stepping = steppings.emplace_back(read_time(table));
    stepping.label = fmt::format("{}, step {}", stepping.integrator->name, stepping.rule.label());
    if (!labels.insert(stepping.label).second) {
      table.place().fail("the same integrator and steps a second time; leave one of them out");
    }
  }
  if (steppings.size() == 1) steppings.front().label.clear();
  return steppings;
}

Stepping read_problem(const Table& root, Study& study) {
  std::vector<Stepping> steppings = read_problem_with_steppings(root, study);
  if (steppings.size() > 1) {
    root.place(*root.find("time")).fail("a study of this kind steps in one way; leave one [[time]]");
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
  const double count = static_cast<double>(N), h = scene.period() / count;
  check_horizon(scene, N, delta, at);
  Case c{.scene = study.scene,
         .scheme = entry.scheme,
         .mu = entry.mu,
         .nonlocal_source = nonlocal_source,
         .source_rule = study.source_rule,
         .integrator = time.integrator,
         .N = N,
         .h = h,
         .delta = delta,
         .dt = 0.0,
         .steps = 0,
         .start = start,
         .step = time.rule};
  const double bound = time.step ? (*time.step)({h, count}) : time.rule.safety * c.lemma_bound(h * start.smallest_gap);
  if (!time.step && std::isinf(bound)) {
    time.at_step.fail(
        fmt::format("step = \"cfl\" where {} is zero, so that no bound limits a step; write an expression "
                    "in h and N such as \"h/4\"",
                    entry.scheme.model == 1 ? "c - b" : "mu"));
  }
  if (!std::isfinite(bound) || bound <= 0.0) {
    time.at_step.fail(fmt::format(
        "step = {:.6g} at h = {:.6g} (N = {}); a time step must be positive and finite: write an expression "
        "in h and N such as \"h/4\"",
        bound, h, N));
  }
  if (scene.T() / bound > 1e12) {
    time.at_step.fail(fmt::format("step = {:.6g} at h = {:.6g} (N = {}) asks for {:.3g} steps; the most is 1e12", bound,
                                  h, N, scene.T() / bound));
  }
  c.steps = steps_for(scene.T(), bound);
  c.dt = c.steps == 0 ? 0.0 : scene.T() / static_cast<double>(c.steps);
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
  }
  const Case& finest = series.cases.back();
  const bool fixed = finest.delta == series.cases.front().delta && series.cases.size() > 1;
  series.theory =
      theory_for(entry.scheme, study.scene->standing(), path.nonlocal_source, fixed, finest.delta < finest.h);
  if (path.order) {
    series.theory.order = *path.order;
    series.theory.statement = "given by the study";
  }
  series.expected = time.expect
                        ? *time.expect
                        : path.expect.value_or(series.theory.order == 0.0 ? Verdict::stagnates : Verdict::confirmed);
  return series;
}

}  // namespace acstudy
