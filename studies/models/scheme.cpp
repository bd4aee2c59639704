#include "studies/models/scheme.hpp"

#include <stdexcept>

#include "solver/model1.hpp"
#include "solver/model2.hpp"
#include "studies/models/control_choice.hpp"
#include "studies/models/scheme_on.hpp"

namespace acstudy {

namespace {

template <class Divergence>
std::unique_ptr<Scheme> make_with(const SchemeChoice& choice, const Scene& scene, double mu) {
  return with_kernel(choice.kernel, [&]<class K>(const K& kernel) {
    if (choice.model == 1) return on(ModelI<K, Divergence>(kernel), scene);
    if constexpr (IntegrableKernel<K>) return on(ModelII<K, Divergence>(kernel, mu), scene);
    throw std::logic_error("Model II with a kernel that is not integrable");
  });
}

}  // namespace

std::unique_ptr<Scheme> make_scheme(const SchemeChoice& choice, const Scene& scene, double mu) {
  if (!choice.control.empty()) return make_control(choice, scene, mu);
  if (scene.standing()) return make_with<NoDivergence>(choice, scene, mu);
  if (choice.nonlocal_divergence) return make_with<NonlocalDivergence>(choice, scene, mu);
  return make_with<LocalDivergence>(choice, scene, mu);
}

NonlocalModel nonlocal_model(const SchemeChoice& choice, double mu, double delta) {
  KernelProfile kernel = with_kernel(choice.kernel, [](const auto& k) { return profile(k); });
  return {choice.model, choice.nonlocal_divergence, std::move(kernel), delta, mu};
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
