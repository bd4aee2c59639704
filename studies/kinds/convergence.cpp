#include <fmt/format.h>

#include <set>

#include "studies/kinds/kinds.hpp"
#include "studies/study_parts.hpp"
#include "studies/theory.hpp"

namespace acstudy {

void read_convergence(const Table& root, Study& study) {
  root.allow({"study", "scene", "scheme", "time", "path", "source"});
  study.scene = read_scene(root.sub_table("scene"));
  const Stepping time = read_time(root);
  study.integrator = time.integrator;
  study.step_text = time.step.text();
  study.source_rule = read_source_rule(root);

  const std::vector<Table> path_tables = root.array_of_tables("path");
  std::vector<PathChoice> paths;
  std::set<std::string> names;
  for (const Table& table : path_tables) {
    paths.push_back(read_path(table));
    if (!names.insert(paths.back().name).second) {
      table.place(*table.find("name"))
          .fail(fmt::format("a second path named \"{}\"; names must differ", paths.back().name));
    }
  }
  for (const SchemeEntry& entry : read_schemes(root, *study.scene)) {
    for (std::size_t p = 0; p < paths.size(); ++p) {
      const PathChoice& path = paths[p];
      Series series{.scheme = entry.scheme,
                    .path = path.name,
                    .delta_text = path.delta.text(),
                    .nonlocal_source = path.nonlocal_source,
                    .theory = {},
                    .expected = Verdict::confirmed,
                    .cases = {}};
      const Place at_delta = path_tables[p].place(*path_tables[p].find("delta"));
      for (const std::int64_t N : path.N) {
        const double count = static_cast<double>(N), delta = path.delta({study.scene->period() / count, count});
        series.cases.push_back(make_case(study, time, entry, N, delta, path.nonlocal_source, at_delta));
      }
      const Case& finest = series.cases.back();
      const bool fixed = finest.delta == series.cases.front().delta && series.cases.size() > 1;
      series.theory =
          theory_for(entry.scheme, study.scene->standing(), path.nonlocal_source, fixed, finest.delta < finest.h);
      if (path.order) {
        series.theory.order = *path.order;
        series.theory.statement = "given by the study";
      }
      series.expected = path.expect.value_or(series.theory.order == 0.0 ? Verdict::stagnates : Verdict::confirmed);
      study.series.push_back(std::move(series));
    }
  }
}

}  // namespace acstudy
