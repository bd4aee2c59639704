/// @file
/// The kernel of a scheme: a name, with its parameter in a table, or a text of the study's own.

#include <fmt/format.h>

#include <algorithm>

#include "studies/reading/nearest.hpp"
#include "studies/reading/shared_tables.hpp"
#include "studies/reading/study_parts.hpp"

namespace acstudy {

namespace {

/// What a study can write where the kernel has to be integrable.
std::string integrable_examples() {
  std::vector<std::string> written = {std::string(find_kernel(integrable_kernel().name)->example())};
  for (const NamedKernel& known : named_kernels) {
    if (!known.parameter || known.parameter->integrable.empty()) continue;
    written.push_back(fmt::format("{} with {}", known.example(), known.parameter->integrable));
  }
  return fmt::format("{}", fmt::join(written, " or "));
}

/// The parameter of a family, from the table that names it.
double read_parameter(const Table& table, const KernelParameter& parameter, const KernelChoice& kernel,
                      const ModelCard& model) {
  const std::string name(parameter.name());
  const toml::node& node = *table.find(name);
  const double value = table.number(name, node);
  if (!parameter.in_range(value)) {
    table.place(node).fail(fmt::format("{} = {}; the {} kernel {}", name, value, kernel.name, parameter.range));
  }
  if (model.needs_integrable_kernel() && !integrable({kernel.name, value})) {
    table.place(node).fail(
        fmt::format("{} = {}; {} needs an integrable kernel: {}", name, value, model.name, parameter.integrable));
  }
  return value;
}

/// A density or a profile of the study's own, from the table that has its text.
KernelChoice read_formula(const Table& table, const ModelCard& model) {
  const toml::node* const profile = table.find("profile");
  KernelFormula formula{.density = profile != nullptr};
  for (const Key& key : scheme_keys) {
    const std::string_view name = key.name.substr(key.name.find('.') + 1);
    if (name == key.name || name == formula.key() || name == "breaks" || (name == "exponent" && !formula.density))
      continue;
    if (const toml::node* const node = table.find(name)) {
      table.place(*node).fail(fmt::format("{} does not go with {}; leave one of them out", name, formula.key()));
    }
  }
  formula.text = table.text(formula.key(), formula.density ? "profile = \"(1-s)^3*(1+3*s)\"" : "eta = \"exp(-s)\"");
  if (const toml::node* const exponent = table.find("exponent")) formula.exponent = table.number("exponent", *exponent);
  std::vector<const toml::node*> breaks;
  if (table.find("breaks") != nullptr) {
    constexpr const char* example = "breaks = [0.25, \"2/3\"]";
    for (const toml::node& point : table.list("breaks", example)) {
      breaks.push_back(&point);
      formula.breaks.push_back(point.is_number() ? fmt::format("{}", table.number("breaks", point))
                                                 : table.text("breaks", point, example));
    }
  }
  const KernelChoice kernel = KernelChoice::written(formula);
  try {
    if (integrable(kernel) || !model.needs_integrable_kernel()) return kernel;
  } catch (const KernelError& error) {
    const toml::node& node = error.key == "breaks" ? *breaks[error.entry] : *table.find(error.key);
    table.place(node).shifted((node.is_string() ? 1 : 0) + error.position).fail(error.what());
  }
  table.place(*table.find("exponent"))
      .fail(fmt::format("exponent = {}; {} needs an integrable kernel: exponent < 1", formula.exponent, model.name));
}

}  // namespace

KernelChoice read_kernel(const Table& scheme, const ModelCard& model) {
  const toml::node& node =
      scheme.need("kernel", fmt::format("kernel = {}", find_kernel(integrable_kernel().name)->example()));
  static const toml::table no_table;
  const toml::table* const table = node.as_table();
  const Table inner(table != nullptr ? *table : no_table, "kernel", scheme.file());
  std::vector<std::string> names;
  for (const NamedKernel& known : named_kernels) names.emplace_back(known.name);
  const toml::node* name_node = &node;
  if (table != nullptr) {
    inner.allow(scheme_keys, "kernel");
    if (inner.find("profile") != nullptr || inner.find("eta") != nullptr) return read_formula(inner, model);
    for (const char* const key : {"breaks", "exponent"}) {
      if (inner.find(key) == nullptr) continue;
      inner.place(*inner.find(key))
          .fail(fmt::format("{} goes with a kernel of your own; write eta = \"exp(-s)\"", key));
    }
    const auto* const family = std::find_if(std::begin(named_kernels), std::end(named_kernels),
                                            [](const NamedKernel& known) { return known.parameter.has_value(); });
    name_node = &inner.need("name", family->example());
  }
  KernelChoice kernel{scheme.text("kernel", *name_node, fmt::format("kernel = {}", named_kernels[0].example()))};
  const NamedKernel* const row = find_kernel(kernel.name);
  if (row == nullptr) {
    scheme.place(*name_node)
        .fail(fmt::format("unknown kernel {}; known kernels: {}{}", in_quotes(kernel.name), fmt::join(names, ", "),
                          did_you_mean(kernel.name, names)));
  }
  for (const NamedKernel& known : named_kernels) {
    const std::string key(known.parameter ? known.parameter->name() : "");
    if (key.empty() || inner.find(key) == nullptr || (row->parameter && row->parameter->name() == key)) continue;
    inner.place(*inner.find(key)).fail(fmt::format("the {} kernel has no {}; leave it out", kernel.name, key));
  }
  if (row->parameter && table == nullptr) {
    scheme.place(node).fail(
        fmt::format("the {} kernel needs its {}; write {}", kernel.name, row->parameter->role, row->example()));
  }
  if (row->parameter && inner.find(std::string(row->parameter->name())) == nullptr) {
    inner.place().fail(
        fmt::format("the {} kernel has no {}; write {}", kernel.name, row->parameter->name(), row->example()));
  }
  if (row->parameter) kernel.parameter = read_parameter(inner, *row->parameter, kernel, model);
  if (model.needs_integrable_kernel() && !integrable(kernel)) {
    scheme.place(*name_node)
        .fail(fmt::format("{} needs an integrable kernel, and the {} kernel is not; write {}", model.name, kernel.name,
                          integrable_examples()));
  }
  return kernel;
}

}  // namespace acstudy
