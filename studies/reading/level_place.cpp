#include "studies/reading/level_place.hpp"

namespace acstudy {

namespace {

/// The first whole number of this value; else, of a table that makes levels, the key `most`.
const toml::node* find_level(const toml::node& node, std::int64_t N) {
  if (node.value_exact<std::int64_t>() == N) return &node;
  const toml::node* found = nullptr;
  if (const toml::array* const array = node.as_array()) {
    for (const toml::node& item : *array) {
      if (found == nullptr) found = find_level(item, N);
    }
  } else if (const toml::table* const table = node.as_table()) {
    for (auto&& [key, item] : *table) {
      if (found == nullptr) found = find_level(item, N);
    }
    if (found == nullptr && table->contains("until")) found = table->get("most");
  }
  return found;
}

}  // namespace

Place place_of_level(const Study& study, const Series& series, std::int64_t N) {
  const toml::table document = parse_toml(study.text, study.file);
  const toml::node* found = nullptr;
  if (const toml::array* const paths = document["path"].as_array()) {
    for (const toml::node& path : *paths) {
      const toml::table* const table = path.as_table();
      const bool of_series = table != nullptr && (*table)["name"].value<std::string>() == series.path;
      if (of_series && found == nullptr) found = find_level(path, N);
    }
  }
  if (found == nullptr) found = find_level(document, N);
  if (found == nullptr) return {study.file, 1, 1};
  return {study.file, found->source().begin.line, found->source().begin.column};
}

}  // namespace acstudy
