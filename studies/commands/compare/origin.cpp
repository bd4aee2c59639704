#include "studies/commands/compare/origin.hpp"

#include <algorithm>

namespace acstudy {

namespace {

std::string value_of(const ResultRecord& study, const std::string& name) {
  const auto found = std::find_if(study.provenance.begin(), study.provenance.end(),
                                  [&](const auto& entry) { return entry.first == name; });
  return found == study.provenance.end() ? "unknown" : found->second;
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

}  // namespace acstudy
