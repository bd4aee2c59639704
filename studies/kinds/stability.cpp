#include "studies/claims/stability.hpp"

#include <fmt/format.h>

#include <set>

#include "studies/kinds/kinds.hpp"
#include "studies/reading/shared_tables.hpp"
#include "studies/reading/study_parts.hpp"

namespace acstudy {

namespace {

void read_stability(const Table& root, Study& study) {
  study.scene = read_scene_with_advection(root.sub_table("scene"));
  const Resolutions resolutions = read_resolutions(root.sub_table("sweep"), *study.scene, 4);  // one horizon is 2h
  const std::vector<Subject> subjects = read_subjects(root, study.scene);

  // The kernels with which Lemma 3.3 as printed is expected to fail.
  std::set<std::string> failing;
  if (root.find("printed") != nullptr) {
    const Table printed = root.sub_table("printed");
    for (const toml::node& item : printed.list("violated", "violated = [\"power(0.9)\"]")) {
      const std::string kernel = printed.text("violated", item, "violated = [\"power(0.9)\"]");
      if (std::none_of(subjects.begin(), subjects.end(), [&](const Subject& subject) {
            return !subject.scheme.model->step_lemma.enough_for_every_kernel && subject.scheme.kernel.label() == kernel;
          })) {
        printed.place(item).fail(fmt::format(
            "no [[scheme]] of Model II has the kernel \"{}\"; name one of those as explain prints it", kernel));
      }
      failing.insert(kernel);
    }
  }

  std::vector<Measurement>& all = study.measurements;
  for (const Subject& subject : subjects) {
    const bool enough = subject.scheme.model->step_lemma.enough_for_every_kernel;
    all.push_back(step_is_bounded(subject, resolutions, StepCondition::printed));
    if (!enough && failing.count(subject.scheme.kernel.label()) > 0) all.back().check.expected = Verdict::violated;
    for (const double cfl : {1.0, 1.5}) {
      all.push_back(step_is_bounded(subject, resolutions, StepCondition::corrected, cfl));
    }
    if (!enough && subject.arrangement == Arrangement::uniform) {
      all.push_back(printed_condition_on_uneven_gaps(subject, resolutions.N));
    }
  }
}

constexpr Key printed_keys[] = {
    {"violated", "list of kernels",
     "those with which the condition printed in Lemma 3.3 fails, as explain prints them"},
};
constexpr TableKeys stability_tables[] = {scene_table, scheme_table, sweep_table, {"[printed]", printed_keys, true}};

}  // namespace

const Kind stability_kind{"stability", "max norm of a forward Euler step", stability_tables, read_stability};

}  // namespace acstudy
