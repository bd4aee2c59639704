/// @file
/// Model I with slopes, and the same with a limiter: of second order, beyond the paper.

#include "solver/line/slopes.hpp"

#include "studies/models/model_card.hpp"
#include "studies/models/scheme_on.hpp"
#include "studies/models/some_kernel.hpp"

namespace acstudy {

namespace {

template <template <class, class> class Scheme>
std::unique_ptr<LineScheme> make(const SchemeChoice& choice, const Scene& scene, double) {
  const auto scheme = [&]<class Divergence>(const SomeKernel& kernel, Divergence) {
    return on(Scheme<SomeKernel, Divergence>(kernel), choice, scene);
  };
  return with_divergence(choice, scene, scheme)(SomeKernel(choice.kernel.kernel()));
}

constexpr ModelCard card() {
  ModelCard card = card_beyond_paper();
  card.number = 3;
  card.name = "slopes";
  card.equations = card.theorems = measured_alone;
  card.left_out = "viscosity and midpoint velocities";
  card.cell_weights = CellWeights::moments_over_distance;
  card.upwind = true;
  card.pair_cost = 3.0;  // slopes take both sides
  card.no_nonlocal_model =
      "slopes go to a nonlocal model with slopes that are averages over the horizon, whose source acstudy does not "
      "integrate";
  card.make = make<Slopes>;
  card.step_lemma.name = "what was measured of its steps";
  card.step_lemma.promised = false;
  card.step_lemma.speed = [](const Scene& scene, double) { return scene.max_relative_velocity(); };
  card.order = 2.0;
  return card;
}

constexpr ModelCard clipped() {
  ModelCard it = card();
  it.number = 4;
  it.limiter = "clip";
  it.linear = false;
  it.no_truncation = "what slopes with a limiter leave of the equation at extremes has no order that is known";
  it.make = make<ClippedSlopes>;
  it.order = 1.0;
  return it;
}

}  // namespace

constinit const ModelCard model_slopes = card();
constinit const ModelCard model_clipped_slopes = clipped();

}  // namespace acstudy
