#include "studies/models/control_choice.hpp"

#include <algorithm>
#include <utility>

#include "solver/line/controls/model1.hpp"
#include "solver/line/controls/model2.hpp"
#include "solver/line/controls/sph.hpp"
#include "studies/models/scheme_on.hpp"
#include "studies/models/some_kernel.hpp"

namespace acstudy {

namespace {

template <class Mistake>
std::unique_ptr<LineScheme> model1(const SchemeChoice& choice, const Scene& scene, double) {
  const auto scheme = [&]<class Divergence>(const SomeKernel& kernel, Divergence) {
    return wrong_sum_on(controls::ModelI<SomeKernel, Divergence, Mistake>(kernel), scene);
  };
  return with_local_divergence(scene, scheme)(SomeKernel(choice.kernel.kernel()));
}

template <class Mistake>
std::unique_ptr<LineScheme> model2(const SchemeChoice& choice, const Scene& scene, double mu) {
  const auto scheme = [&]<class Divergence>(const SomeKernel& kernel, Divergence) {
    return wrong_sum_on(controls::ModelII<SomeKernel, Divergence, Mistake>(kernel, mu), scene);
  };
  return with_local_divergence(scene, scheme)(integrable_one(choice.kernel));
}

template <bool viscous>
std::unique_ptr<LineScheme> sph(const SchemeChoice& choice, const Scene& scene, double mu) {
  const auto scheme = [&]<class Divergence>(const SomeKernel& kernel, Divergence) {
    return wrong_sum_on(controls::ClassicalSph<SomeKernel, Divergence>(kernel, viscous ? mu : 0.0), scene);
  };
  return with_local_divergence(scene, scheme)(integrable_one(choice.kernel));
}

using controls::Forgotten;
constexpr const ModelCard *one = &model_one, *two = &model_two, *any = nullptr;

constexpr Control table[] = {
    {"SPH sum", two, "kernel values times particle volumes, no viscosity", sph<false>},
    {"SPH sum with viscosity", two, "kernel values times particle volumes", sph<true>},
    {"no tail weight", one, "the outermost cell ends at its particle, not at the horizon",
     model1<controls::NoTailWeight>},
    {"point quadrature", one, "kernel values times gaps in the place of cell moments",
     model1<controls::PointQuadrature>},
    {"downwind", one, "looks to the side from which nothing comes", model1<controls::Downwind>},
    {"no nearest neighbor", one, "an empty sum where no neighbor is within the horizon",
     model1<controls::NoNearestNeighbor>},
    {"no renormalization", two, "1 in the place of N_j", model2<controls::NoRenormalization>},
    {"no viscosity", two, "0 in the place of mu", model2<controls::NoViscosity>},
    {"half viscosity", two, "mu/2 in the place of mu", model2<controls::HalfViscosity>},
    {"horizon as viscous factor", two, "delta in the place of reach_j", model2<controls::HorizonViscosity>},
    {"half horizon as viscous factor", two, "delta/2 in the place of reach_j", model2<controls::HalfHorizonViscosity>},
    {.name = "no divergence term", .model = any, .mistake = "b' u is missing", .forgotten = Forgotten::divergence_term},
    {.name = "absolute velocity",
     .model = any,
     .mistake = "c in the place of c - b",
     .forgotten = Forgotten::particle_velocity},
    {.name = "source off by 1 %", .model = any, .mistake = "1.01 f in the place of f", .source_factor = 1.01},
    {.name = "misprinted trajectories",
     .model = any,
     .mistake = "tan(x/2) = 2 tan(x_0) e^t in the place of tan(x/2) = tan(x_0/2) e^t",
     .flow = misprinted_flow,
     .flow_of_b = "sin(x)"},
};

}  // namespace

std::span<const Control> named_controls() { return table; }

const Control* find_control(std::string_view name) {
  const auto* const found =
      std::find_if(std::begin(table), std::end(table), [&](const Control& known) { return known.name == name; });
  return found == std::end(table) ? nullptr : found;
}

MisprintedParticles::MisprintedParticles(const Scene&, std::vector<double> start)
    : flow_(misprinted_flow, {"x", "t"}), start_(std::move(start)), x_(start_.size()) {}

std::span<const double> MisprintedParticles::at(double t) {
  flow_.evaluate(start_, {t}, {x_, {}, {}});
  return x_;
}

}  // namespace acstudy
