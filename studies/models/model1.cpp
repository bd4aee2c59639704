/// @file
/// Model I: upwind kernel.

#include "solver/line/model1.hpp"

#include <cmath>

#include "studies/models/model_card.hpp"
#include "studies/models/scheme_on.hpp"

namespace acstudy {

namespace {

std::unique_ptr<LineScheme> make(const SchemeChoice& choice, const Scene& scene, double) {
  const auto scheme = [&]<class K, class Divergence>(const K& kernel, Divergence) {
    return on(ModelI<K, Divergence>(kernel), choice, scene);
  };
  return with_kernel(choice.kernel, with_divergence(choice, scene, scheme));
}

/// (2.4), (2.9) and (2.11).
PrintedRate printed_rate(const PrintedAt& at) {
  const auto& [scheme, scene, mu, x, u, delta, j] = at;
  const double x_j = x[j], u_j = u[j];
  const PrintedVelocity v{scene};
  const bool nonlocal = scheme.nonlocal_divergence;
  PrintedSum rate;
  if (!nonlocal) rate.add(-v.b_prime(x_j) * u_j, v.b_prime(x_j) * u_j);
  const int s = v.c_hat(x_j) > 0.0 ? +1 : -1;
  const std::vector<PrintedNeighbor> near = printed_neighbors(at, s);
  double inner = 0.0;
  for (std::size_t k = 0; k < near.size(); ++k) {
    const PrintedNeighbor& i = near[k];
    const double d = std::abs(i.z);
    const double outer = k + 1 < near.size() ? first_moment(scheme.kernel, std::min(d / delta, 1.0)) : 1.0;
    const double W = (outer - inner) / d;
    const double own = nonlocal ? v.c(x_j) - v.b(i.x) : v.c_hat(x_j);
    rate.add(-s * (own * u_j - v.c_hat(i.x) * i.u) * W,
             ((v.size(x_j) + v.size(i.x)) * std::abs(u_j) + v.size(i.x) * std::abs(i.u)) * W);
    inner = outer;
  }
  return {rate.value, rate.size};
}

std::array<double, 3> nearest_row(const SchemeChoice& choice, const Scene& scene, double, double, const double* x) {
  const PrintedVelocity v{scene};
  const bool looks_left = v.c_hat(x[0]) > 0.0;
  const double s = looks_left ? 1.0 : -1.0, d = looks_left ? x[0] - x[-1] : x[1] - x[0], i = looks_left ? x[-1] : x[1];
  const double b_prime =
      choice.nonlocal_divergence && !scene.standing() ? s * (v.b(x[0]) - v.b(i)) / d : v.b_prime(x[0]);
  std::array<double, 3> row = {0.0, -s * v.c_hat(x[0]) / d - b_prime, 0.0};
  row[looks_left ? 0 : 2] = s * v.c_hat(i) / d;
  return row;
}

double constant(const EstimateAt& at) {
  return 0.5 * (at.fields.flux_2 + (at.nonlocal_divergence ? at.fields.b_2 * at.fields.u : 0.0));
}

constexpr LemmaEstimate estimates[] = {
    {"Lemma 2.3", "max |G_h - G|", false, true, constant},
    {"Lemma 2.5", "max |G_h - d/dx|", false, false, constant},
};

}  // namespace

constinit const ModelCard model_one = {
    .number = 1,
    .name = "Model I",
    .equations = {"(2.4)", "(2.9)", "(2.11)"},
    .left_out = "viscosity and midpoint velocities",

    .cell_weights = CellWeights::moments_over_distance,
    .upwind = true,
    .viscous = false,
    .renormalized = false,
    .conserves_any_sign = false,

    .pair_cost = 1.0,
    .row_terms = 1.0,
    .pde_constant = 0.5,
    .divergence_part = 0.5,  // G[b] is the average of b' over the horizon

    .vector_form = VectorForm::upwind,
    .continuum = &upwind_continuum,
    .make = make,
    .printed_rate = printed_rate,

    .theorems = {"Theorem 2.6", "Theorem 2.7", "Theorem 2.8"},
    .step_lemma = {.name = "Lemma 2.4",
                   .row_by_row = "Lemma 2.4, row by row",
                   .sharp = "monotone exactly up to c dt sum_k W_k = 1",
                   .where_positive = "while c - b keeps its sign",
                   .m_matrix = "an M-matrix at any step while c - b keeps its sign and dt ||b'|| < 1",
                   .limit = "c - b",
                   .speed = [](const Scene& scene, double) { return scene.max_relative_velocity(); },
                   .enough_for_every_kernel = true},
    .to_nonlocal = "Lemma 2.3",
    .to_pde = "Lemma 2.5",
    .estimates = estimates,
    .weights = {"Remark 2.2", "W_k >= 0", "Remark 2.2", "sum d_k W_k = 1"},
    .nearest = {"Remark 2.1", "the upwind difference", "the upwind difference (Remark 2.1)", true, nearest_row},
    .mistakes = {.inconsistent = "no tail weight", .not_monotone = "downwind", .classical = ""},
};

}  // namespace acstudy
