#include "studies/models/scheme.hpp"

#include "studies/models/control_choice.hpp"

namespace acstudy {

std::unique_ptr<Scheme> make_scheme(const SchemeChoice& choice, const Scene& scene, double mu) {
  return choice.control.empty() ? choice.model->make(choice, scene, mu) : make_control(choice, scene, mu);
}

NonlocalModel nonlocal_model(const SchemeChoice& choice, double mu, double delta) {
  KernelProfile kernel = with_kernel(choice.kernel, [](const auto& k) { return profile(k); });
  return {choice.model->continuum, choice.nonlocal_divergence, std::move(kernel), delta, mu};
}

std::unique_ptr<Source> make_source(const SchemeChoice& choice, const Scene& scene, double mu, bool nonlocal,
                                    double delta, SourceRule rule, std::size_t refinement) {
  if (!choice.control.empty()) {
    SchemeChoice itself = choice;
    itself.control.clear();
    return make_control_source(choice.control, make_source(itself, scene, mu, nonlocal, delta, rule, refinement));
  }
  if (!nonlocal) return local_source(scene);
  return nonlocal_source(scene, nonlocal_model(choice, mu, delta), rule, refinement);
}

}  // namespace acstudy
