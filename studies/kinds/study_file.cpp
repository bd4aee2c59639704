#include "studies/kinds/study_file.hpp"

#include <fmt/format.h>

#include <algorithm>
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

Study parse_study(const std::string& text, const std::string& file) {
  toml::table document;
  try {
    document = toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    const auto at = error.source().begin;
    Place{file, at.line, at.column}.fail("not TOML: " + std::string(error.description()));
  }
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
  if (study.name == "cost") {
    header.place(*header.find("name"))
        .fail("name = \"cost\"; the report gives that name to its run-time figure, choose another");
  }
  study.title = header.find("title") != nullptr ? header.text("title", "title = \"...\"") : study.name;
  allow_keys(document, **kind, file);
  (*kind)->read(root, study);
  require_names(study);
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
