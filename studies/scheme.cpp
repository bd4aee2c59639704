#include "studies/scheme.hpp"

#include <stdexcept>

#include "solver/model1.hpp"
#include "solver/model2.hpp"

namespace acstudy {

namespace {

template <class K, class Divergence>
Stencil stencil_of(const ModelI<K, Divergence>& scheme, std::ptrdiff_t j, const Windows&) {
  const auto weights = scheme.weights(j);
  const std::ptrdiff_t s = scheme.looks_left(j) ? +1 : -1;
  Stencil stencil{{}, {weights.begin(), weights.end()}};
  for (std::ptrdiff_t k = 1; k <= std::ssize(weights); ++k) stencil.offset.push_back(-s * k);
  return stencil;
}

template <class K, class Divergence>
Stencil stencil_of(const ModelII<K, Divergence>& scheme, std::ptrdiff_t j, const Windows& windows) {
  const auto weights = scheme.weights(j);
  Stencil stencil{{}, {weights.begin(), weights.end()}, scheme.renormalization(j)};
  for (std::ptrdiff_t k = -windows.left[j]; k <= windows.right[j]; ++k) {
    if (k != 0) stencil.offset.push_back(k);
  }
  return stencil;
}

template <class Model>
class SchemeOn final : public Scheme {
 public:
  SchemeOn(Model model, const Scene& scene) : model_(std::move(model)), scene_(scene) {}
  void place(const Particles& particles) override {
    windows_ = &particles.windows;
    model_.place(particles, scene_);
  }
  void rate(PeriodicArray& u, std::span<double> du) override { model_.rate(u, du); }
  Stencil stencil(std::ptrdiff_t j) const override { return stencil_of(model_, j, *windows_); }
  WorkCounts work() const override { return model_.work(); }

 private:
  Model model_;
  const Scene& scene_;
  const Windows* windows_ = nullptr;
};

template <class Model>
std::unique_ptr<Scheme> on(Model model, const Scene& scene) {
  return std::make_unique<SchemeOn<Model>>(std::move(model), scene);
}

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
  if (scene.standing()) return make_with<NoDivergence>(choice, scene, mu);
  if (choice.nonlocal_divergence) return make_with<NonlocalDivergence>(choice, scene, mu);
  return make_with<LocalDivergence>(choice, scene, mu);
}

std::unique_ptr<Source> make_source(const SchemeChoice& choice, const Scene& scene, double mu, bool nonlocal,
                                    double delta, SourceRule rule, std::size_t refinement) {
  if (!nonlocal) return local_source(scene);
  KernelProfile kernel = with_kernel(choice.kernel, [](const auto& k) { return profile(k); });
  return nonlocal_source(scene, {choice.model, choice.nonlocal_divergence, std::move(kernel), delta, mu}, rule,
                         refinement);
}

}  // namespace acstudy
