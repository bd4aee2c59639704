#include "studies/models/scheme.hpp"

#include "studies/models/control_choice.hpp"

namespace acstudy {

std::unique_ptr<LineScheme> make_scheme(const SchemeChoice& choice, const Scene& scene, double mu) {
  const bool own_sum = choice.control != nullptr && choice.control->make != nullptr;
  return own_sum ? choice.control->make(choice, scene, mu) : choice.model->make(choice, scene, mu);
}

namespace {

class ScaledSource : public Source {
 public:
  ScaledSource(std::unique_ptr<Source> source, double factor) : source_(std::move(source)), factor_(factor) {}
  void place(const Points& x) override { source_->place(x); }
  void evaluate(double t, std::span<double> f) override {
    source_->evaluate(t, f);
    for (double& value : f) value *= factor_;
  }
  std::int64_t quadrature_points() const override { return source_->quadrature_points(); }

 private:
  std::unique_ptr<Source> source_;
  double factor_;
};

}  // namespace

NonlocalModel nonlocal_model(const SchemeChoice& choice, double mu, double delta) {
  KernelProfile kernel = with_kernel(choice.kernel, [](const auto& k) { return profile(k); });
  return {choice.model->continuum, choice.nonlocal_divergence, std::move(kernel), delta, mu};
}

std::unique_ptr<Source> make_source(const SchemeChoice& choice, const Scene& scene, double mu, bool nonlocal,
                                    double delta, SourceRule rule, std::size_t refinement) {
  auto source =
      nonlocal ? nonlocal_source(scene, nonlocal_model(choice, mu, delta), rule, refinement) : local_source(scene);
  if (choice.control == nullptr || choice.control->source_factor == 1.0) return source;
  return std::make_unique<ScaledSource>(std::move(source), choice.control->source_factor);
}

}  // namespace acstudy
