#include "studies/study_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

#include "studies/theory.hpp"

namespace acstudy {

namespace {

/// Control characters of a quoted value spelled out: a message is one line.
std::string on_one_line(const std::string& text) {
  std::string line;
  for (const char c : text) {
    if (c == '\n') {
      line += "\\n";
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      line += fmt::format("\\x{:02x}", static_cast<int>(c));
    } else {
      line += c;
    }
  }
  return line;
}

/// A place in a study file.
struct Place {
  std::string file;
  std::uint32_t line = 0, column = 0;

  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(fmt::format("{}:{}:{}: {}", file, line, column, on_one_line(message)));
  }
  Place shifted(std::size_t by) const { return {file, line, column + static_cast<std::uint32_t>(by)}; }
};

/// A table of the study file that knows where it stands and which of its keys have been read.
class Table {
 public:
  Table(const toml::table& table, std::string title, std::string file)
      : table_(table), title_(std::move(title)), file_(std::move(file)) {}

  Place place() const { return at(table_.source()); }
  Place place(const toml::node& node) const { return at(node.source()); }
  const std::string& file() const { return file_; }

  /// Rejects keys that are not in `known`.
  void allow(const std::vector<std::string>& known) const {
    for (const auto& [key, value] : table_) {
      if (std::find(known.begin(), known.end(), key.str()) == known.end()) {
        at(key.source())
            .fail(fmt::format("unknown key \"{}\" in {}; known keys: {}", key.str(), title_, fmt::join(known, ", ")));
      }
    }
  }

  const toml::node* find(std::string_view key) const { return table_.get(key); }

  const toml::node& need(std::string_view key, std::string_view example) const {
    const toml::node* const node = find(key);
    if (node == nullptr) place().fail(fmt::format("{} has no \"{}\"; write, for example, {}", title_, key, example));
    return *node;
  }

  std::string text(std::string_view key, std::string_view example) const {
    return text(key, need(key, example), example);
  }
  std::string text(std::string_view key, const toml::node& node, std::string_view example) const {
    if (const auto value = node.value_exact<std::string>()) return *value;
    place(node).fail(fmt::format("{} must be a string, not {}; write, for example, {}", key, described(node), example));
  }

  /// An expression or a plain number, as text; `offset` becomes the distance from the node to the first character.
  std::string expression_text(std::string_view key, std::string_view example, std::size_t& offset) const {
    const toml::node& node = need(key, example);
    offset = 0;
    if (const auto value = node.value_exact<double>()) {
      if (!std::isfinite(*value)) place(node).fail(fmt::format("{} = {}; it must be finite", key, described(node)));
      return fmt::format("{:.17g}", *value);
    }
    if (const auto value = node.value_exact<std::int64_t>()) return fmt::format("{}", *value);
    offset = 1;
    if (const auto value = node.value_exact<std::string>()) return *value;
    place(node).fail(fmt::format("{} must be an expression or a number, not {}; write, for example, {}", key,
                                 described(node), example));
  }

  double number(std::string_view key, const toml::node& node) const {
    if (const auto value = node.value<double>(); value && node.is_number()) return *value;
    place(node).fail(fmt::format("{} must be a number, not {}", key, described(node)));
  }

  /// One of a list of words.
  template <class T>
  T choice(std::string_view key, const toml::node& node, const std::vector<std::pair<std::string, T>>& words) const {
    const auto value = node.value_exact<std::string>();
    std::vector<std::string> quoted;
    for (const auto& [word, meaning] : words) {
      if (value && *value == word) return meaning;
      quoted.push_back("\"" + word + "\"");
    }
    place(node).fail(fmt::format("{} = {}; it must be one of {}", key, described(node), fmt::join(quoted, ", ")));
  }

  static std::string described(const toml::node& node) {
    std::ostringstream out;
    if (node.is_table()) return "a table";
    if (node.is_array()) return "an array";
    if (const auto value = node.value_exact<std::string>()) return "\"" + *value + "\"";
    if (const auto value = node.value_exact<double>()) {
      const std::string text = fmt::format("{}", *value);
      return text.find_first_not_of("-0123456789") == std::string::npos ? text + ".0" : text;
    }
    node.visit([&](const auto& n) { out << n; });
    return out.str();
  }

 private:
  Place at(const toml::source_region& region) const { return {file_, region.begin.line, region.begin.column}; }

  const toml::table& table_;
  std::string title_;
  std::string file_;
};

Expression compile(const Table& table, std::string_view key, std::string_view example,
                   const std::vector<std::string>& variables) {
  std::size_t offset = 0;
  const std::string text = table.expression_text(key, example, offset);
  try {
    return Expression(text, variables);
  } catch (const ExpressionError& error) {
    table.place(*table.find(key))
        .shifted(offset + error.position)
        .fail(fmt::format("{} = \"{}\": {}", key, text, error.what()));
  }
}

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
      table.place(*named).fail(fmt::format("unknown scene \"{}\"; known scenes: {}", name, fmt::join(known, ", ")));
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

KernelChoice read_kernel(const Table& scheme, const toml::node& node, int model) {
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
        .fail(fmt::format("unknown kernel \"{}\"; known kernels: {}", kernel.name, fmt::join(known, ", ")));
  }

  const toml::node* const alpha = table != nullptr ? inner.find("alpha") : nullptr;
  if (alpha != nullptr) {
    if (kernel.name != "power") {
      inner.place(*alpha).fail(fmt::format("the {} kernel has no alpha; leave it out", kernel.name));
    }
    kernel.alpha = inner.number("alpha", *alpha);
    if (!std::isfinite(kernel.alpha) || kernel.alpha >= 2.0) {
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
  const toml::node& model = table.need("model", "model = 1");
  const auto number = model.value_exact<std::int64_t>();
  if (!number || (*number != 1 && *number != 2)) {
    table.place(model).fail(fmt::format("model = {}; it must be 1 or 2", Table::described(model)));
  }
  scheme.model = static_cast<int>(*number);
  const toml::node* const divergence = table.find("divergence");
  if (divergence != nullptr) {
    scheme.nonlocal_divergence = table.choice<bool>("divergence", *divergence, {{"local", false}, {"nonlocal", true}});
  } else if (!scene.standing()) {
    table.need("divergence", "divergence = \"local\"");
  }
  scheme.kernel = read_kernel(table, table.need("kernel", "kernel = \"cubic-spline\""), scheme.model);
  if (const toml::node* const mu = table.find("mu")) {
    if (scheme.model == 1) table.place(*mu).fail("Model I has no viscosity; leave mu out");
    scheme.mu = table.number("mu", *mu);
    if (!std::isfinite(*scheme.mu) || *scheme.mu < 0.0) {
      table.place(*mu).fail(fmt::format("mu = {}; a viscosity bound must be finite and not negative", *scheme.mu));
    }
  }
  return scheme;
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

PathChoice read_path(const Table& table) {
  table.allow({"name", "delta", "N", "source", "expect", "order"});
  const toml::node& name = table.need("name", "name = \"delta = 4h\"");
  PathChoice path{.name = table.text("name", name, "name = \"delta = 4h\""),
                  .delta = compile(table, "delta", "delta = \"4*h\"", {"h", "N"}),
                  .N = read_levels(table),
                  .nonlocal_source = table.choice<bool>("source", table.need("source", "source = \"local\""),
                                                        {{"local", false}, {"nonlocal", true}}),
                  .expect = std::nullopt,
                  .order = std::nullopt};
  if (path.name.empty()) table.place(name).fail("a path needs a name, for example \"delta = 4h\"");
  if (const toml::node* const expect = table.find("expect")) {
    std::vector<std::pair<std::string, Verdict>> words;
    for (int v = 0; v <= static_cast<int>(Verdict::inconclusive); ++v) {
      words.emplace_back(name_of(static_cast<Verdict>(v)), static_cast<Verdict>(v));
    }
    path.expect = table.choice<Verdict>("expect", *expect, words);
  }
  if (const toml::node* const order = table.find("order")) {
    path.order = table.number("order", *order);
    if (!std::isfinite(*path.order) || *path.order < 0.0) {
      table.place(*order).fail(fmt::format("order = {}; an order must be finite and not negative", *path.order));
    }
  }
  return path;
}

/// The tables of an array such as [[scheme]].
std::vector<Table> read_array(const toml::table& root, std::string_view key, const std::string& file) {
  const toml::node* const node = root.get(key);
  const std::string title = fmt::format("[[{}]]", key);
  if (node == nullptr) Place{file, 1, 1}.fail(fmt::format("the study has no {}; add at least one", title));
  const auto region = node->source().begin;
  const toml::array* const array = node->as_array();
  if (array == nullptr || !array->is_homogeneous(toml::node_type::table)) {
    Place{file, region.line, region.column}.fail(
        fmt::format("{} must be a list of tables; write {} above its keys", key, title));
  }
  std::vector<Table> tables;
  for (const toml::node& item : *array) tables.emplace_back(*item.as_table(), title, file);
  return tables;
}

Table read_table(const toml::table& root, std::string_view key, const std::string& file) {
  const toml::node* const node = root.get(key);
  if (node == nullptr) Place{file, 1, 1}.fail(fmt::format("the study has no [{}]; add it", key));
  if (!node->is_table()) {
    const auto region = node->source().begin;
    Place{file, region.line, region.column}.fail(fmt::format("{0} must be a table; write [{0}] above its keys", key));
  }
  return {*node->as_table(), fmt::format("[{}]", key), file};
}

std::vector<Case> make_cases(const Study& study, const Table& path_table, const PathChoice& path,
                             const Table& time_table, const Expression& step, const SchemeChoice& scheme, double mu) {
  std::vector<Case> cases;
  const Scene& scene = *study.scene;
  for (const std::int64_t N : path.N) {
    const double count = static_cast<double>(N), h = scene.period() / count;
    const double delta = path.delta({h, count}), bound = step({h, count});
    const Place at_delta = path_table.place(*path_table.find("delta"));
    if (!std::isfinite(delta) || delta <= 0.0) {
      at_delta.fail(fmt::format(
          "delta = {:.6g} at h = {:.6g} (N = {}); a horizon must be positive and finite: write an expression "
          "in h and N such as \"4*h\"",
          delta, h, N));
    }
    if (delta >= 0.5 * scene.period()) {
      at_delta.fail(
          fmt::format("delta = {:.6g} at h = {:.6g} (N = {}); a horizon must stay below half the period, {:.6g}, or a "
                      "particle would meet its own images",
                      delta, h, N, 0.5 * scene.period()));
    }
    const Place at_step = time_table.place(*time_table.find("step"));
    if (!std::isfinite(bound) || bound <= 0.0) {
      at_step.fail(fmt::format(
          "step = {:.6g} at h = {:.6g} (N = {}); a time step must be positive and finite: write an expression "
          "in h and N such as \"h/4\"",
          bound, h, N));
    }
    if (scene.T() / bound > 1e12) {
      at_step.fail(fmt::format("step = {:.6g} at h = {:.6g} (N = {}) asks for {:.3g} steps; the most is 1e12", bound, h,
                               N, scene.T() / bound));
    }
    const std::int64_t steps = steps_for(scene.T(), bound);
    cases.push_back({.scene = study.scene,
                     .scheme = scheme,
                     .mu = mu,
                     .nonlocal_source = path.nonlocal_source,
                     .source_rule = study.source_rule,
                     .integrator = study.integrator,
                     .N = N,
                     .h = h,
                     .delta = delta,
                     .dt = scene.T() / static_cast<double>(steps),
                     .steps = steps});
  }
  return cases;
}

}  // namespace

Study parse_study(const std::string& text, const std::string& file) {
  toml::table root;
  try {
    root = toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    const auto at = error.source().begin;
    std::string message(error.description());
    Place{file, at.line, at.column}.fail("not TOML: " + message);
  }
  Table(root, "the study", file).allow({"study", "scene", "scheme", "time", "path", "source"});

  Study study;
  study.file = file;
  study.text = text;
  const Table header = read_table(root, "study", file);
  header.allow({"name", "title"});
  study.name = header.text("name", "name = \"fig2\"");
  if (study.name.empty() ||
      study.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") != std::string::npos) {
    header.place(*header.find("name"))
        .fail(fmt::format("name = \"{}\"; it names result files and may use a-z, 0-9 and - only", study.name));
  }
  if (study.name == "cost") {
    header.place(*header.find("name"))
        .fail("name = \"cost\"; the report gives that name to its run-time figure, choose another");
  }
  study.title = header.find("title") != nullptr ? header.text("title", "title = \"...\"") : study.name;

  study.scene = read_scene(read_table(root, "scene", file));

  const Table time = read_table(root, "time", file);
  time.allow({"integrator", "step"});
  std::vector<std::pair<std::string, const Integrator*>> integrator_words;
  for (const Integrator& integrator : integrators) integrator_words.emplace_back(integrator.name, &integrator);
  study.integrator =
      time.choice("integrator", time.need("integrator", "integrator = \"forward-euler\""), integrator_words);
  const Expression step = compile(time, "step", "step = \"h/4\"", {"h", "N"});
  study.step_text = step.text();

  study.source_rule = SourceRule::gauss;
  if (root.get("source") != nullptr) {
    const Table source = read_table(root, "source", file);
    source.allow({"rule"});
    study.source_rule = source.choice<SourceRule>(
        "rule", source.need("rule", "rule = \"gauss\""),
        {{"gauss", SourceRule::gauss}, {"gsl", SourceRule::gsl}, {"boost", SourceRule::boost}});
  }

  const auto scheme_tables = read_array(root, "scheme", file);
  const auto path_tables = read_array(root, "path", file);
  std::vector<PathChoice> paths;
  std::set<std::string> path_names;
  for (const Table& table : path_tables) {
    paths.push_back(read_path(table));
    if (!path_names.insert(paths.back().name).second) {
      table.place(*table.find("name"))
          .fail(fmt::format("a second path named \"{}\"; names must differ", paths.back().name));
    }
  }

  std::set<std::string> scheme_keys;
  const bool standing = study.scene->standing();
  double widest = -1.0;
  for (const Table& scheme_table : scheme_tables) {
    const SchemeChoice scheme = read_scheme(scheme_table, *study.scene);
    if (scheme.model == 2 && !scheme.mu && widest < 0.0) widest = study.scene->max_relative_velocity();
    const double mu = scheme.model == 1 ? 0.0 : scheme.mu.value_or(widest);
    if (!scheme_keys
             .insert(fmt::format("{}|{}|{}|{}", scheme.model, scheme.nonlocal_divergence, scheme.kernel.label(), mu))
             .second) {
      scheme_table.place().fail("the same scheme a second time; leave one of them out");
    }
    for (std::size_t p = 0; p < paths.size(); ++p) {
      const PathChoice& path = paths[p];
      Series series{.scheme = scheme,
                    .path = path.name,
                    .delta_text = path.delta.text(),
                    .nonlocal_source = path.nonlocal_source,
                    .theory = {},
                    .expected = Verdict::confirmed,
                    .cases = make_cases(study, path_tables[p], path, time, step, scheme, mu)};
      const Case& finest = series.cases.back();
      const bool fixed = finest.delta == series.cases.front().delta && series.cases.size() > 1;
      series.theory = theory_for(scheme, standing, path.nonlocal_source, fixed, finest.delta < finest.h);
      if (path.order) {
        series.theory.order = *path.order;
        series.theory.statement = "given by the study";
      }
      series.expected = path.expect.value_or(series.theory.order == 0.0 ? Verdict::stagnates : Verdict::confirmed);
      study.series.push_back(std::move(series));
    }
  }
  return study;
}

Study read_study(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) {
    throw InputError(fmt::format("{}: cannot read the study file; name an existing, non-empty file", file));
  }
  constexpr std::size_t most = 60'000;  // an attribute of the result file holds it
  if (text.str().size() > most) {
    throw InputError(
        fmt::format("{}: {} bytes; a study file may have at most {}: split it", file, text.str().size(), most));
  }
  return parse_study(text.str(), file);
}

}  // namespace acstudy
