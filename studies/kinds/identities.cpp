#include "studies/claims/identities.hpp"

#include <set>

#include "studies/kinds/kinds.hpp"
#include "studies/reading/shared_tables.hpp"
#include "studies/reading/study_parts.hpp"

namespace acstudy {

namespace {

void read_identities(const Table& root, Study& study) {
  study.scene = read_scene_with_advection(root.sub_table("scene"));
  const Sweep sweep = read_sweep(root.sub_table("sweep"), *study.scene);
  const auto add = [&](std::string name, std::function<Finding()> take) {
    study.measurements.push_back({std::move(name), [take = std::move(take)](const auto&) { return take(); }});
  };
  std::set<std::string> kernels;
  for (const Subject& subject : read_subjects(root, study.scene)) {
    const KernelChoice& kernel = subject.scheme.kernel;
    if (kernels.insert(kernel.label()).second) {
      add("(2.3): kernel " + kernel.label(), [=] { return kernel_moments(kernel); });
    }
    const auto add_for_subject = [&](const std::string& statement, const std::string& check,
                                     std::function<Finding()> take) {
      add(subject.finding(statement, {}, check, {}, Test::bounds).label(), std::move(take));
    };
    add_for_subject("Remark 2.1", "delta below every gap",
                    [=] { return nearest_neighbor_rows(subject, sweep.N, 0.9); });
    add_for_subject("Remark 2.1", "delta above every gap",
                    [=] { return nearest_neighbor_rows(subject, sweep.N, 4.0); });
    add_for_subject("Remark 2.2", "weights", [=] { return weights_are_not_negative(subject, sweep); });
    add_for_subject(subject.scheme.model->renormalized ? "(3.4)" : "Remark 2.2", "first moment",
                    [=] { return first_moment_is_one(subject, sweep); });
    if (!subject.scheme.model->renormalized) continue;
    add_for_subject("(3.4)", "sum of weights", [=] { return weights_cancel(subject, sweep); });
    add_for_subject("(3.5)", "second moment", [=] { return second_moment_is_bounded(subject, sweep, false); });
    add_for_subject("(3.5), with |W_k|", "second moment",
                    [=] { return second_moment_is_bounded(subject, sweep, true); });
    add_for_subject("Lemma 3.1", "whatever delta", [=] { return renormalization_is_near_one(subject, sweep); });
    for (const double delta : sweep.horizons) {
      add_for_subject("Lemma 3.1", "fixed horizon", [=] { return order_of_renormalization(subject, sweep.N, delta); });
    }
    if (subject.arrangement == Arrangement::uniform) {
      add_for_subject("Lemma 3.1, as printed", "patterns of gaps",
                      [=] { return renormalization_is_at_least_one(subject, 16); });
    }
  }
}

constexpr TableKeys tables[] = {scene_table, scheme_table, sweep_table};

}  // namespace

const Kind identities_kind{"identities", "what the weights satisfy, exactly or within bounds", tables, read_identities};

}  // namespace acstudy
