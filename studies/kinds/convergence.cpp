#include <fmt/format.h>

#include <set>

#include "studies/cases/series_verdict.hpp"
#include "studies/kinds/kinds.hpp"
#include "studies/reading/program_part.hpp"
#include "studies/reading/shared_tables.hpp"
#include "studies/reading/study_parts.hpp"

namespace acstudy {

namespace {

void read_convergence(const Table& root, Study& study) {
  const std::vector<Stepping> steppings = read_problem_with_steppings(root, study, Solution::may_be_unknown);

  const std::vector<Table> path_tables = root.array_of_tables("path");
  std::vector<PathChoice> paths;
  std::set<std::string> names;
  for (const Table& table : path_tables) {
    paths.push_back(
        read_path(table, {.solved = study.scene->solved(), .needs_delta = !programs_alone(root), .adds_levels = true}));
    if (!names.insert(paths.back().name).second) {
      table.place(*table.find("name"))
          .fail(fmt::format("a second path named {}; names must differ", in_quotes(paths.back().name)));
    }
  }
  for (const SchemeEntry& entry : read_schemes(root, *study.scene, Programs::taken)) {
    for (std::size_t p = 0; p < paths.size(); ++p) {
      const toml::node* const delta = path_tables[p].find("delta");
      const Place at_delta = delta != nullptr ? path_tables[p].place(*delta) : path_tables[p].place();
      for (const Stepping& time : steppings) {
        study.series.push_back(make_series(study, time, entry, paths[p], at_delta));
        study.measurements.push_back(series_verdict(study.series.back(), study.series.size() - 1));
      }
    }
  }
}

constexpr TableKeys convergence_tables[] = {scene_table, scheme_table, times_table, path_table, source_table};

}  // namespace

const Kind convergence_kind{"convergence", "errors of runs along refinement paths", convergence_tables,
                            read_convergence, true};

}  // namespace acstudy
