#include "studies/claims/identities.hpp"

#include <set>

#include "studies/kinds/kinds.hpp"
#include "studies/reading/shared_tables.hpp"
#include "studies/reading/study_parts.hpp"

namespace acstudy {

namespace {

void read_identities(const Table& root, Study& study) {
  study.scene = read_scene_with_advection(root.sub_table("scene"));
  const Resolutions resolutions = read_resolutions(root.sub_table("sweep"), *study.scene, 9);  // one ratio is 4
  std::vector<Measurement>& all = study.measurements;
  std::set<std::string> kernels;
  for (const Subject& subject : read_subjects(root, study.scene)) {
    const KernelChoice& kernel = subject.scheme.kernel;
    if (kernels.insert(kernel.label()).second) all.push_back(kernel_moments(kernel));
    for (const double ratio : {0.9, 4.0}) all.push_back(nearest_neighbor_rows(subject, resolutions.N, ratio));
    all.push_back(weights_are_not_negative(subject, resolutions));
    all.push_back(first_moment_is_one(subject, resolutions));
    if (!subject.scheme.model->renormalized) continue;
    all.push_back(weights_cancel(subject, resolutions));
    for (const bool one_sided : {false, true}) all.push_back(second_moment_is_bounded(subject, resolutions, one_sided));
    all.push_back(renormalization_is_near_one(subject, resolutions));
    for (const double delta : resolutions.horizons)
      all.push_back(order_of_renormalization(subject, resolutions.N, delta));
    if (subject.arrangement == Arrangement::uniform) all.push_back(renormalization_is_at_least_one(subject, 16));
  }
}

constexpr TableKeys identities_tables[] = {scene_table, scheme_table, sweep_table};

}  // namespace

const Kind identities_kind{"identities", "what the weights satisfy, exactly or within bounds", identities_tables,
                           read_identities};

}  // namespace acstudy
