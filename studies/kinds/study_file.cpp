#include "studies/kinds/study_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "studies/kinds/kinds.hpp"
#include "studies/reading/shared_tables.hpp"
#include "studies/reading/toml_table.hpp"

namespace acstudy {

namespace {

/// Rejects tables and keys that are not of the kind.
void allow_keys(const toml::table& document, const Kind& kind, const std::string& file) {
  std::vector<std::string> names{"study"};
  for (const TableKeys& table : kind.tables) names.emplace_back(table.name());
  Table(document, "the study", file).allow(names);
  for (const TableKeys& table : kind.tables) {
    const toml::node* const node = document.get(table.name());
    if (node == nullptr) continue;  // whoever needs it says so
    if (const toml::table* const one = node->as_table()) {
      Table(*one, fmt::format("[{}]", table.name()), file).allow(table.keys);
    } else if (const toml::array* const several = node->as_array()) {
      for (const toml::node& item : *several) {
        if (!item.is_table()) continue;
        Table(*item.as_table(), fmt::format("[[{}]]", table.name()), file).allow(table.keys);
      }
    }
  }
}

/// Rejects schemes that somebody has added where all that is measured is what theory says of those of the paper.
void require_known_schemes(const toml::table& document, const Kind& kind, const std::string& file) {
  const toml::array* const schemes = document["scheme"].as_array();
  if (kind.own_schemes || schemes == nullptr) return;
  for (const toml::node& scheme : *schemes) {
    const toml::table* const table = scheme.as_table();
    const toml::node* const model = table != nullptr ? table->get("model") : nullptr;
    if (model == nullptr || !model->is_string()) continue;
    std::vector<std::string_view> others;
    for (const Kind* one : kinds) {
      if (one->own_schemes) others.push_back(one->name);
    }
    Table(*table, "[[scheme]]", file)
        .place(*model)
        .fail(
            fmt::format("a study of kind {} measures what theory says of Models I and II; examine {} in one of kind {}",
                        kind.name, Table::described(*model), fmt::join(others, ", ")));
  }
}

}  // namespace

namespace {

/// A name is all that a reader, a gate or a CI service tells a check by.
void require_names(Study& study) {
  std::vector<Check*> checks;
  for (Measurement& measurement : study.measurements) checks.push_back(&measurement.check);
  if (const std::string name = tell_apart(checks); !name.empty()) {
    throw InputError(
        fmt::format("{}: two checks have the name {}; leave one of them out, or give its path another name", study.file,
                    in_quotes(name)));
  }
}

}  // namespace

namespace {

/// @throws MissingKey for the first key that is not there
Study read_document(const toml::table& document, const std::string& text, const std::string& file) {
  const Table root(document, "the study", file);

  Study study;
  study.file = file;
  study.text = text;
  const Table header = root.sub_table("study");
  header.allow(study_keys);
  const toml::node* const kind_node = header.find("kind");
  study.kind = kind_node == nullptr ? kinds.front()->name : header.text("kind", *kind_node, "kind = \"convergence\"");
  const auto* const kind =
      std::find_if(kinds.begin(), kinds.end(), [&](const Kind* known) { return known->name == study.kind; });
  if (kind == kinds.end()) {
    std::vector<std::string> known;
    for (const Kind* one : kinds) known.push_back("\"" + std::string(one->name) + "\"");
    header.place(*kind_node)
        .fail(fmt::format("kind = {}; it must be one of {}", in_quotes(study.kind), fmt::join(known, ", ")));
  }
  study.name = header.text("name", "name = \"fig2\"");
  if (study.name.empty() ||
      study.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") != std::string::npos) {
    header.place(*header.find("name"))
        .fail(fmt::format("name = {}; it names result files and may use a-z, 0-9 and - only", in_quotes(study.name)));
  }
  constexpr std::size_t most_letters =
      200;  // a file system takes 255, and files that are being written have longer names
  if (study.name.size() > most_letters) {
    header.place(*header.find("name"))
        .fail(fmt::format("name = {}; it names result files and may have at most {} letters: write a shorter one",
                          in_quotes(study.name), most_letters));
  }
  if (study.name.front() == '-') {
    header.place(*header.find("name"))
        .fail(fmt::format("name = {}; a command would take {}.json for an option: begin with a letter or a digit",
                          in_quotes(study.name), study.name));
  }
  if (study.name == "bench") {
    header.place(*header.find("name"))
        .fail("name = \"bench\"; acstudy bench gives that name to its files, choose another");
  }
  if (study.name == "cost") {
    header.place(*header.find("name"))
        .fail("name = \"cost\"; the report gives that name to its run-time figure, choose another");
  }
  study.title = header.find("title") != nullptr ? header.text("title", "title = \"...\"") : study.name;
  allow_keys(document, **kind, file);
  require_known_schemes(document, **kind, file);
  (*kind)->read(root, study);
  require_names(study);
  return study;
}

/// A table of a document by its address.
toml::table* find_table(toml::node& node, const toml::table* wanted) {
  toml::table* const table = node.as_table();
  if (table == wanted) return table;
  toml::table* found = nullptr;
  const auto look = [&](toml::node& inner) {
    if (found == nullptr) found = find_table(inner, wanted);
  };
  if (table != nullptr) {
    for (auto&& [key, inner] : *table) look(inner);
  } else if (toml::array* const array = node.as_array()) {
    for (toml::node& inner : *array) look(inner);
  }
  return found;
}

/// Writes the example where the key is missing, and leaves of it what is TOML. False if it cannot be.
bool write_example(toml::table& document, MissingKey& missing) {
  toml::table* const table = find_table(document, missing.table);
  toml::table example;
  std::string written = missing.example;
  while (table != nullptr && example.empty()) {
    try {
      example = toml::parse(written);
    } catch (const toml::parse_error&) {
      const std::size_t words = written.rfind(", ");
      if (words == std::string::npos) return false;
      written.erase(words);
    }
  }
  missing.example = written;
  bool new_key = false;
  for (auto&& [key, value] : example) {
    value.visit([&, &name = key](const auto& node) { new_key = table->insert(name, node).second || new_key; });
  }
  return new_key;
}

/// All keys that are missing, in one message.
std::string text_of(const std::vector<MissingKey>& missing) {
  std::vector<std::string> groups;
  std::size_t keys = 0;
  for (std::size_t i = 0; i < missing.size();) {
    const MissingKey& first = missing[i];
    if (first.title.empty()) {  // a table, whose keys are missing too
      ++i;
      continue;
    }
    std::vector<std::string> examples;
    for (; i < missing.size() && missing[i].table == first.table; ++i) examples.push_back(missing[i].example);
    keys += examples.size();
    const bool elsewhere = first.place.line > 0 && first.place.line != missing.front().place.line;
    groups.push_back(fmt::format("{} in {}{}", fmt::join(examples, " and "), first.title,
                                 elsewhere ? fmt::format(" (line {})", first.place.line) : ""));
  }
  return fmt::format("{} keys are missing; write, for example, {}", keys, fmt::join(groups, ", "));
}

}  // namespace

Study parse_study(const std::string& text, const std::string& file) {
  toml::table document = parse_toml(text, file);
  // With examples in place of missing keys the study is read on, up to those that are missing behind them.
  std::vector<MissingKey> missing;
  for (;;) {
    try {
      Study study = read_document(document, text, file);
      if (missing.empty()) return study;
      break;
    } catch (const MissingKey& error) {
      missing.push_back(error);
      if (!write_example(document, missing.back())) break;
    } catch (const InputError&) {
      if (missing.empty()) throw;
      break;
    }
  }
  // A table that is missing is named without its keys, if nothing else is.
  const MissingKey& first = missing.front();
  const bool one_place = std::all_of(missing.begin() + 1, missing.end(), [&](const MissingKey& one) {
    return first.title.empty() && one.title == first.example;
  });
  if (one_place) throw InputError(first.what());
  std::stable_sort(missing.begin(), missing.end(), [](const MissingKey& a, const MissingKey& b) {
    return a.place.line != 0 && (b.place.line == 0 || a.place.line < b.place.line);
  });
  missing.front().place.fail(text_of(missing));
}

Study read_study(const std::string& file) {
  if (std::error_code none; std::filesystem::is_directory(file, none)) {
    throw InputError(
        fmt::format("{}: a folder; name its study files: {}", file, (std::filesystem::path(file) / "*.toml").string()));
  }
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

std::vector<Study> read_studies(const std::vector<std::string>& files) {
  std::vector<Study> studies;
  std::set<std::string> names;
  for (const std::string& file : files) {
    studies.push_back(read_study(file));
    if (!names.insert(studies.back().name).second) {
      throw InputError(fmt::format("{}: a second study named \"{}\"; it would overwrite the results of the first", file,
                                   studies.back().name));
    }
  }
  return studies;
}

}  // namespace acstudy
