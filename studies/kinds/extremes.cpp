#include "studies/claims/extremes.hpp"

#include "studies/kinds/kinds.hpp"
#include "studies/reading/shared_tables.hpp"
#include "studies/reading/study_parts.hpp"

namespace acstudy {

namespace {

void read_extremes(const Table& root, Study& study) {
  // Rows bring their own scenes, in some of which particles move: a scheme has to say how it writes the divergence.
  const Scene moving(named_scenes().front());
  Extremes extremes;
  for (const SchemeEntry& entry : read_schemes(root, moving)) extremes.schemes.push_back(entry.scheme);
  for (const Table& scheme : root.array_of_tables("scheme")) {
    if (const toml::node* const mu = scheme.find("mu")) {
      scheme.place(*mu).fail(
          "every row of the table of extremes has its own viscosity bound, max |c - b|; leave mu out");
    }
  }
  if (root.find("extremes") != nullptr) {
    const Table table = root.sub_table("extremes");
    const auto read = [&](std::string_view key, std::int64_t& value, std::int64_t least, std::int64_t largest) {
      if (const toml::node* const node = table.find(key)) value = table.whole(key, *node, least, largest);
    };
    read("N", extremes.most_particles, 100, 10'000'000);
    read("steps", extremes.most_steps, 100, 1'000'000'000);
    read("levels", extremes.levels, 4, 7);
  }
  study.measurements = extreme_rows(extremes);
}

constexpr Key extremes_keys[] = {
    {"N", "whole number", "the largest number of particles", "1000000"},
    {"steps", "whole number", "the largest number of steps", "1000000"},
    {"levels", "whole number", "levels of N, 4 to 7, where an order is measured", "5"},
};
constexpr TableKeys extremes_tables[] = {scheme_table, {"[extremes]", extremes_keys, true}};

}  // namespace

const Kind extremes_kind{"extremes", "expectation and observation at the ends of every range", extremes_tables,
                         read_extremes};

}  // namespace acstudy
