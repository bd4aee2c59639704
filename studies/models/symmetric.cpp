/// @file
/// A symmetric Model II: of second order and conservative, beyond the paper.

#include "solver/line/symmetric.hpp"

#include "studies/models/model_card.hpp"
#include "studies/models/scheme_on.hpp"
#include "studies/models/some_kernel.hpp"

namespace acstudy {

namespace {

std::unique_ptr<LineScheme> make(const SchemeChoice& choice, const Scene& scene, double mu) {
  const auto scheme = [&]<class Divergence>(const SomeKernel& kernel, Divergence) {
    return on(Symmetric<SomeKernel, Divergence>(kernel, mu), choice, scene);
  };
  return with_divergence(choice, scene, scheme)(integrable_one(choice.kernel));
}

constexpr ModelCard card() {
  ModelCard card = card_beyond_paper();
  card.number = 5;
  card.name = "symmetric";
  card.equations = card.theorems = measured_alone;
  card.cell_weights = CellWeights::masses;
  card.viscous = true;
  card.conserves_any_sign = true;
  card.pair_cost = 4.0;
  card.carries_volumes = true;
  card.no_nonlocal_model =
      "symmetric goes to a nonlocal model with an average of averages over the horizon, whose source acstudy does not "
      "integrate";
  card.no_truncation =
      "what symmetric leaves of the equation on uneven particles is not of its order, which only its errors are";
  card.make = make;
  card.step_lemma.name = "what was measured of its steps";
  card.step_lemma.promised = false;
  card.step_lemma.limit = "mu";
  card.step_lemma.speed = [](const Scene&, double mu) { return mu; };
  card.order = 2.0;
  return card;
}

}  // namespace

constinit const ModelCard model_symmetric = card();

}  // namespace acstudy
