#include "studies/commands/compare/origin.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "studies/commands/compare/folded.hpp"

namespace acstudy {

namespace {

std::string value_of(const ResultRecord& study, const std::string& name) {
  const auto found = std::find_if(study.provenance.begin(), study.provenance.end(),
                                  [&](const auto& entry) { return entry.first == name; });
  return found == study.provenance.end() ? "unknown" : found->second;
}

std::string set_text(const char* which, const ResultSet& set) {
  std::string first, last;
  for (const ResultRecord& study : set.studies) {
    for (const auto& [name, value] : study.provenance) {
      if (name != "created") continue;
      first = first.empty() ? value : std::min(first, value);
      last = std::max(last, value);
    }
  }
  const std::string when = first.empty()   ? ""
                           : first == last ? " of " + first
                                           : fmt::format(" of {} to {}", first, last);
  return fmt::format("{}  {}: {} {}{}", which, set.path, set.studies.size(),
                     set.studies.size() == 1 ? "study" : "studies", when);
}

std::string values_text(const std::set<std::string>& values) {
  return values.size() == 1 ? *values.begin() : fmt::format("{} different: {}", values.size(), fmt::join(values, ", "));
}

}  // namespace

std::vector<Origin> origins(const Comparison& comparison) {
  std::vector<Origin> all = {{.name = "version"},
                             {.name = "numerics", .decides = true},
                             {.name = "compiler", .decides = true},
                             {.name = "flags", .decides = true},
                             {.name = "libraries", .decides = true},
                             {.name = "machine", .decides = true},
                             {.name = "vectors", .decides = true},
                             {.name = "system", .decides = true}};
  for (const StudyComparison& study : comparison.studies) {
    if (!study.both()) continue;
    for (Origin& one : all) {
      one.before.insert(value_of(*study.before, one.name));
      one.after.insert(value_of(*study.after, one.name));
    }
  }
  return all;
}

std::string origin_text(const Comparison& comparison, bool all) {
  Block lines = folded(set_text("OLD", *comparison.before), "", "     ");
  append(lines, folded(set_text("NEW", *comparison.after), "", "     "));
  std::vector<std::string> alike, causes;
  const std::vector<Origin> found = origins(comparison);
  const auto differing = std::count_if(found.begin(), found.end(), [](const Origin& one) { return one.differs(); });
  const std::size_t most = differing > 3 ? 1 : 2;  // lines of each, so that the whole stays on a screen
  for (const Origin& one : found) {
    if (!one.differs()) {
      alike.push_back(one.name == "machine" || one.name == "compiler" || one.name == "version" || one.name == "flags"
                          ? fmt::format("{} {}", one.name, *one.before.begin())
                          : one.name);
      continue;
    }
    if (one.decides) causes.push_back(one.name);
    const Block said =
        folded(fmt::format("{}: OLD {}, NEW {}", one.name, values_text(one.before), values_text(one.after)), "     ",
               "       ");
    append(lines, all ? said : shortened(said, most));
  }
  if (!alike.empty()) append(lines, folded(fmt::format("the same: {}", fmt::join(alike, "; ")), "     ", "       "));
  if (comparison.numbers.differ()) {
    std::string said =
        "nothing that decides a run differs, and runs are deterministic: the study files differ, or the ";
    said += "sources that measure and judge, or a file was changed";
    if (!causes.empty()) {
      said = fmt::format("runs are deterministic: numbers differ because of {}, or of the study files",
                         fmt::join(causes, ", "));
    }
    append(lines, folded(said, "     ", "     "));
  }
  std::string text = "\n";
  print_to(text, lines);
  return text;
}

}  // namespace acstudy
