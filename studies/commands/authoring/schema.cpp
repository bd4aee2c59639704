#include "studies/commands/authoring/schema.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "mms/scene.hpp"
#include "solver/time/integrators.hpp"
#include "studies/kinds/kinds.hpp"
#include "studies/models/control_choice.hpp"
#include "studies/models/kernel_choice.hpp"
#include "studies/reading/shared_tables.hpp"

namespace acstudy {

namespace {

using json = nlohmann::ordered_json;

template <class Rows>
json names_of(const Rows& rows) {
  json names = json::array();
  for (const auto& row : rows) names.push_back(row.name);
  return {{"type", "string"}, {"enum", names}};
}

/// "local" and nonlocal of "\"local\", \"nonlocal\"".
json words_of(std::string_view written) {
  json words = json::array();
  for (std::size_t begin = written.find('"'); begin != std::string_view::npos; begin = written.find('"', begin)) {
    const std::size_t end = written.find('"', begin + 1);
    words.push_back(written.substr(begin + 1, end - begin - 1));
    begin = end + 1;
  }
  return {{"type", "string"}, {"enum", words}};
}

json value_schema(std::string_view written);

/// A kernel by its name, or as a table with its parameters.
json kernel_schema() {
  json properties = json::object();
  for (const Key& key : scheme_keys) {
    if (const std::string_view inside = "kernel."; key.name.starts_with(inside)) {
      json& one = properties[std::string(key.name.substr(inside.size()))];
      one = key.written == "a kernel" ? names_of(named_kernels) : value_schema(key.written);
      one["description"] = key.meaning;
    }
  }
  return {
      {"anyOf",
       {names_of(named_kernels), {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}}}}};
}

json value_schema(std::string_view written) {
  if (const std::string_view list = "list of "; written.starts_with(list)) {
    std::string_view one = written.substr(list.size());
    if (one.find('"') == std::string_view::npos && one.ends_with('s')) one.remove_suffix(1);
    return {{"type", "array"}, {"items", value_schema(one)}, {"minItems", 1}};
  }
  if (written.starts_with('"')) return words_of(written);
  if (written == "expression, or a list") {
    const json one = value_schema("expression");
    return {{"anyOf", {one, {{"type", "array"}, {"items", one}, {"minItems", 1}}}}};
  }
  if (written.starts_with("expression")) return {{"type", {"string", "number"}}};
  if (written == "whole number") return {{"type", "integer"}};
  if (written == "number above 0") return {{"type", "number"}, {"exclusiveMinimum", 0}};
  if (written == "number, 0 or more") return {{"type", "number"}, {"minimum", 0}};
  if (written == "number, 0 to 1") return {{"type", "number"}, {"minimum", 0}, {"maximum", 1}};
  if (written == "number") return {{"type", "number"}};
  if (written == "table") return {{"type", "object"}};
  if (written == "a scene") return names_of(named_scenes());
  if (written.ends_with("integrator")) return names_of(integrators);
  if (written == "a control") return names_of(named_controls());
  if (written == "a model") return {{"type", {"integer", "string"}}};
  if (written == "a kernel") return kernel_schema();
  if (written == "a kind") {
    json names = json::array();
    for (const Kind* kind : kinds) names.push_back(kind->name);
    return {{"type", "string"}, {"enum", names}};
  }
  return {{"type", "string"}};
}

/// Adds the keys of a table; those of an inline table stand inside the key that has it.
void add_keys(json& table, std::span<const Key> keys) {
  json& properties = table["properties"];
  for (const Key& key : keys) {
    json schema = value_schema(key.written);
    schema["description"] = std::string(key.meaning) + "; " + (key.left_out.starts_with("needed") ? "" : "left out: ") +
                            std::string(key.left_out);
    const std::size_t dot = key.name.find('.');
    const std::string outer(key.name.substr(0, dot));
    if (dot == std::string_view::npos) {
      if (!properties.contains(outer)) properties[outer] = std::move(schema);
      continue;
    }
    if (outer == "kernel") continue;
    json& of = properties[outer];
    if (!of.contains("anyOf")) {
      const json description = of["description"];
      of.erase("description");
      of = {{"description", description},
            {"anyOf", {of, {{"type", "object"}, {"properties", json::object()}, {"additionalProperties", false}}}}};
    }
    json& inner = of["anyOf"][1]["properties"];
    const std::string name(key.name.substr(dot + 1));
    if (!inner.contains(name)) inner[name] = std::move(schema);
  }
}

/// A table as "[scene]", "[[scheme]]" or "[time] or [[time]]" says that it stands.
json table_schema(std::string_view title, json table) {
  const bool several = title.find("[[") != std::string_view::npos, one = title.front() == '[' && title[1] != '[';
  json array = {{"type", "array"}, {"items", table}, {"minItems", 1}};
  if (!several) return table;
  if (!one) return array;
  return {{"anyOf", {table, array}}};
}

}  // namespace

std::string study_schema() {
  json tables = json::object();  // by name: the keys of all kinds that have the table
  json titles = json::object();
  const auto add = [&](const TableKeys& table) {
    const std::string name(table.name());
    json& known = tables[name];
    if (known.is_null()) {
      known = {{"type", "object"}, {"properties", json::object()}, {"additionalProperties", false}};
      titles[name] = table.title;
    } else if (table.title.size() > titles[name].get<std::string>().size()) {
      titles[name] = table.title;
    }
    add_keys(known, table.keys);
  };
  add(study_table);
  tables["study"]["required"] = {"name"};
  json of_kinds = json::array();
  for (const Kind* const kind : kinds) {
    json names = {"study"};
    json needed = {"study"};
    for (const TableKeys& table : kind->tables) {
      add(table);
      names.push_back(table.name());
      if (!table.optional) needed.push_back(table.name());
    }
    json is_kind = {{"properties", {{"study", {{"properties", {{"kind", {{"const", kind->name}}}}}}}}}};
    if (kind != kinds.front()) is_kind["properties"]["study"]["required"] = {"kind"};
    of_kinds.push_back({{"if", is_kind}, {"then", {{"propertyNames", {{"enum", names}}}, {"required", needed}}}});
  }
  json root = {{"$schema", "http://json-schema.org/draft-07/schema#"},
               {"title", "acstudy study file"},
               {"type", "object"},
               {"required", {"study"}}};
  for (auto& [name, table] : tables.items()) {
    root["properties"][name] = table_schema(titles[name].get<std::string>(), table);
  }
  root["allOf"] = of_kinds;
  return root.dump(1) + "\n";
}

}  // namespace acstudy
