#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "studies/commands/list.hpp"
#include "studies/kinds/kinds.hpp"
#include "studies/reading/input_error.hpp"
#include "studies/reading/shared_tables.hpp"

namespace acstudy {

namespace {

/// Tables of the same keys: the lines above them, as "[time]  map", and the kinds that have them.
struct Entry {
  std::span<const Key> keys;
  std::vector<std::pair<std::string, std::string>> headings;
};

void add(std::vector<Entry>& entries, const TableKeys& table, std::string_view kind) {
  auto entry = std::find_if(entries.begin(), entries.end(),
                            [&](const Entry& known) { return known.keys.data() == table.keys.data(); });
  if (entry == entries.end()) entry = entries.insert(entry, {table.keys, {}});
  const std::string title = std::string(table.title) + (table.optional ? ", optional" : "");
  for (auto& [known, kinds_that_have_it] : entry->headings) {
    if (known != title) continue;
    kinds_that_have_it += fmt::format(", {}", kind);
    return;
  }
  entry->headings.emplace_back(title, kind);
}

}  // namespace

std::string keys_text(const std::string& kind) {
  std::string out;
  std::vector<Entry> entries;
  std::vector<std::string_view> names;
  add(entries, study_table, kind.empty() ? "every kind" : kind);
  for (const Kind* const one : kinds) {
    names.push_back(one->name);
    if (!kind.empty() && one->name != kind) continue;
    for (const TableKeys& table : one->tables) add(entries, table, one->name);
  }
  if (!kind.empty() && std::find(names.begin(), names.end(), kind) == names.end()) {
    throw InputError(
        fmt::format("no kind of study is named {}; write one of {}", in_quotes(kind), fmt::join(names, ", ")));
  }
  for (const Entry& entry : entries) {
    if (&entry != &entries.front()) out += fmt::format("\n");
    for (const auto& [title, kinds_that_have_it] : entry.headings)
      out += fmt::format("{}  {}\n", title, kinds_that_have_it);
    for (const Key& key : entry.keys) {
      const bool needed = key.left_out.substr(0, 6) == "needed";
      out += fmt::format("  {:<18} {:<24} {}; {}{}\n", key.name, key.written, key.meaning,
                         needed ? "" : "left out: ", key.left_out);
    }
  }
  return out;
}

}  // namespace acstudy
