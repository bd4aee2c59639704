#include "studies/models/control_choice.hpp"

#include <stdexcept>
#include <utility>

#include "solver/controls/model1.hpp"
#include "solver/controls/model2.hpp"
#include "solver/controls/sph.hpp"
#include "solver/controls/velocity.hpp"
#include "solver/model1.hpp"
#include "solver/model2.hpp"
#include "studies/models/scheme_on.hpp"

namespace acstudy {

namespace {

template <class Velocity, class Model>
std::unique_ptr<Scheme> with_velocity(Model model, const Scene& scene) {
  return std::make_unique<SchemeOn<Model, Velocity>>(std::move(model), Velocity{scene});
}

/// The scheme itself, with a velocity that may be wrong: mistakes that either model can make.
template <class Model>
std::unique_ptr<Scheme> scheme_itself(const SchemeChoice& choice, const Scene& scene, Model model) {
  if (choice.control == "no divergence term") {
    return with_velocity<controls::NoDivergenceTerm<Scene>>(std::move(model), scene);
  }
  if (choice.control == "absolute velocity") {
    return with_velocity<controls::AbsoluteVelocity<Scene>>(std::move(model), scene);
  }
  if (choice.control == "source off by 1 %" || choice.control == misprinted_trajectories) {
    return on(std::move(model), scene);
  }
  throw std::logic_error("no control of this model is named " + choice.control);
}

template <class Divergence, class K>
std::unique_ptr<Scheme> model1(const SchemeChoice& choice, const Scene& scene, const K& kernel) {
  using namespace controls;
  const auto made = [&]<class Mistake>(Mistake) { return on(controls::ModelI<K, Divergence, Mistake>(kernel), scene); };
  if (choice.control == "no tail weight") return made(NoTailWeight{});
  if (choice.control == "point quadrature") return made(PointQuadrature{});
  if (choice.control == "downwind") return made(Downwind{});
  if (choice.control == "no nearest neighbor") return made(NoNearestNeighbor{});
  return scheme_itself(choice, scene, acstudy::ModelI<K, Divergence>(kernel));
}

template <class Divergence, class K>
std::unique_ptr<Scheme> model2(const SchemeChoice& choice, const Scene& scene, double mu, const K& kernel) {
  using namespace controls;
  const auto made = [&]<class Mistake>(Mistake) {
    return on(controls::ModelII<K, Divergence, Mistake>(kernel, mu), scene);
  };
  if (choice.control == "SPH sum") return on(ClassicalSph<K, Divergence>(kernel, 0.0), scene);
  if (choice.control == "SPH sum with viscosity") return on(ClassicalSph<K, Divergence>(kernel, mu), scene);
  if (choice.control == "no renormalization") return made(NoRenormalization{});
  if (choice.control == "no viscosity") return made(NoViscosity{});
  if (choice.control == "half viscosity") return made(HalfViscosity{});
  if (choice.control == "horizon as viscous factor") return made(HorizonViscosity{});
  if (choice.control == "half horizon as viscous factor") return made(HalfHorizonViscosity{});
  return scheme_itself(choice, scene, acstudy::ModelII<K, Divergence>(kernel, mu));
}

template <class Divergence>
std::unique_ptr<Scheme> make_with(const SchemeChoice& choice, const Scene& scene, double mu) {
  return with_kernel(choice.kernel, [&]<class K>(const K& kernel) {
    if (choice.model == &model_one) return model1<Divergence>(choice, scene, kernel);
    if constexpr (IntegrableKernel<K>) return model2<Divergence>(choice, scene, mu, kernel);
    throw std::logic_error("Model II with a kernel that is not integrable");
  });
}

class ScaledSource : public Source {
 public:
  ScaledSource(std::unique_ptr<Source> source, double factor) : source_(std::move(source)), factor_(factor) {}
  void place(std::span<const double> x) override { source_->place(x); }
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

std::unique_ptr<Scheme> make_control(const SchemeChoice& choice, const Scene& scene, double mu) {
  if (scene.standing()) return make_with<NoDivergence>(choice, scene, mu);
  if (choice.nonlocal_divergence) throw std::logic_error("a control of the nonlocal divergence");
  return make_with<LocalDivergence>(choice, scene, mu);
}

std::unique_ptr<Source> make_control_source(std::string_view control, std::unique_ptr<Source> source) {
  if (control == "source off by 1 %") return std::make_unique<ScaledSource>(std::move(source), 1.01);
  return source;
}

const char* const misprinted_flow = "2*atan2(1, cos(x)/(2*sin(x))*exp(-t))";

MisprintedParticles::MisprintedParticles(const Scene&, std::vector<double> start)
    : flow_(misprinted_flow, {"x", "t"}), start_(std::move(start)), x_(start_.size()) {}

std::span<const double> MisprintedParticles::at(double t) {
  flow_.evaluate(start_, {t}, {x_, {}, {}});
  return x_;
}

}  // namespace acstudy
