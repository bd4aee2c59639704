#include "studies/claims/consistency.hpp"

#include <fmt/format.h>

#include "studies/kinds/kinds.hpp"
#include "studies/reading/shared_tables.hpp"

namespace acstudy {

namespace {

void read_consistency(const Table& root, Study& study) {
  study.scene = read_scene(root.sub_table("scene"));
  const Resolutions resolutions = read_resolutions(root.sub_table("sweep"), *study.scene, 1);
  std::vector<PathChoice> paths;
  for (const Table& table : root.array_of_tables("path")) {
    const PathChoice& path = paths.emplace_back(read_path(table));
    for (const std::int64_t N : path.N) {
      const double count = static_cast<double>(N), delta = path.delta({study.scene->period() / count, count});
      check_horizon(*study.scene, N, delta, table.place(*table.find("delta")));
    }
  }

  for (const Subject& subject : read_subjects(root, study.scene)) {
    if (const std::string_view reason = subject.scheme.model->no_truncation; !reason.empty()) {
      root.place(*root.find("scheme")).fail(fmt::format("{}; examine it in a study of kind convergence", reason));
    }
    if (subject.scheme.model->beyond_paper) {
      for (const PathChoice& path : paths) {
        if (!path.nonlocal_source) study.measurements.push_back(truncation_along(subject, path, {{"path", path.name}}));
      }
      continue;
    }
    for (const LemmaEstimate& estimate : subject.scheme.model->estimates) {
      // D does not depend on how the divergence is written.
      if (estimate.viscous && subject.scheme.nonlocal_divergence) continue;
      std::vector<Measurement>& all = study.measurements;
      all.push_back(consistency_whatever_delta(subject, estimate, resolutions));
      for (const PathChoice& path : paths) {
        if (path.nonlocal_source == estimate.nonlocal) all.push_back(consistency_along(subject, estimate, path));
      }
      if (!estimate.second_term.empty()) {
        all.push_back(order_below_spacing(subject, estimate, resolutions.N, 0.01));
        all.push_back(growth_below_spacing(subject, estimate, resolutions.N.back(), resolutions.ratios));
      }
    }
  }
}

constexpr TableKeys consistency_tables[] = {scene_table, scheme_table, sweep_table, path_table};

}  // namespace

const Kind consistency_kind{"consistency", "truncation errors of the operators, no time stepping", consistency_tables,
                            read_consistency, true};

}  // namespace acstudy
