/// @file
/// Model II: renormalized SPH with vanishing nonlocal viscosity.

#include "solver/line/model2.hpp"

#include <algorithm>
#include <cmath>

#include "studies/models/model_card.hpp"
#include "studies/models/scheme_on.hpp"

namespace acstudy {

namespace {

std::unique_ptr<LineScheme> make(const SchemeChoice& choice, const Scene& scene, double mu) {
  const auto scheme = [&]<class K, class Divergence>(const K& kernel, Divergence) {
    return on(ModelII<K, Divergence>(kernel, mu), choice, scene);
  };
  return with_integrable_kernel(choice.kernel, with_divergence(choice, scene, scheme));
}

/// (3.6), (3.8) and (3.10).
PrintedRate printed_rate(const PrintedAt& at) {
  const auto& [scheme, scene, mu, x, u, delta, j] = at;
  const double x_j = x[j], u_j = u[j];
  const PrintedVelocity v{scene};
  const bool nonlocal = scheme.nonlocal_divergence;
  PrintedSum rate, N, A, D, B;
  if (!nonlocal) rate.add(-v.b_prime(x_j) * u_j, v.b_prime(x_j) * u_j);
  double reach = delta;
  for (const int s : {+1, -1}) {
    const std::vector<PrintedNeighbor> near = printed_neighbors(at, s);
    double inner = 0.0;
    for (std::size_t k = 0; k < near.size(); ++k) {
      const PrintedNeighbor& i = near[k];
      const double outer = mass(scheme.kernel, k + 1 < near.size() ? std::min(std::abs(i.z) / delta, 1.0) : 1.0);
      const double W = -s * (outer - inner) / (2.0 * delta), middle = 0.5 * (x_j + i.x);
      N.add(i.z * W, i.z * W);
      A.add(v.c_hat(middle) * (u_j + i.u) * W, v.size(middle) * (std::abs(u_j) + std::abs(i.u)) * W);
      D.add((i.u - u_j) / i.z * W, (std::abs(i.u) + std::abs(u_j)) / i.z * W);
      B.add(2.0 * v.b(middle) * W, 2.0 * v.b(middle) * W);
      inner = outer;
    }
    reach = std::max(reach, std::abs(near.back().z));
  }
  rate.add(-A.value / N.value, A.size / N.value);
  rate.add(mu * reach * D.value / N.value, mu * reach * D.size / N.value);
  if (nonlocal) rate.add(-B.value / N.value * u_j, B.size / N.value * u_j);
  return {rate.value, rate.size};
}

std::array<double, 3> nearest_row(const SchemeChoice& choice, const Scene& scene, double mu, double delta,
                                  const double* x) {
  const PrintedVelocity v{scene};
  const double left = x[0] - x[-1], right = x[1] - x[0], both = left + right;
  const double to_left = 0.5 * (x[0] + x[-1]), to_right = 0.5 * (x[0] + x[1]);
  const double b_prime =
      choice.nonlocal_divergence && !scene.standing() ? 2.0 * (v.b(to_right) - v.b(to_left)) / both : v.b_prime(x[0]);
  const double viscosity = mu * std::max({left, right, delta});
  return {(v.c_hat(to_left) + viscosity / left) / both,
          (v.c_hat(to_left) - v.c_hat(to_right) - viscosity / left - viscosity / right) / both - b_prime,
          (-v.c_hat(to_right) + viscosity / right) / both};
}

double curvature(const EstimateAt& at) {
  const FieldBounds& f = at.fields;
  return 0.5 * f.c_hat_2 * f.u + f.c_hat_1 * f.u_1 + f.c_hat * f.u_2 +
         0.5 * (at.nonlocal_divergence ? f.b_2 * f.u : 0.0);
}

/// Whichever is smaller: by way of the PDE, or by the weights, whose sums are near one where delta is beyond the gaps.
double to_nonlocal(const EstimateAt& at, double pde, double weights) {
  const double by_way_of_pde = pde * std::max(1.0, at.delta / at.gap.largest);
  if (at.delta < at.gap.largest) return by_way_of_pde;
  const double mass = total_mass(at.kernel);
  const double least_N =
      std::max(at.gap.smallest / (at.gap.smallest + at.gap.largest), 1.0 - mass * at.gap.largest / at.delta);
  return std::min(by_way_of_pde, mass / least_N * weights);
}

constexpr LemmaEstimate estimates[] = {
    {"Lemma 3.2, A", "max |A_h - A|", false, true,
     [](const EstimateAt& at) { return to_nonlocal(at, curvature(at), 1.5 * curvature(at)); }, "h^2/delta"},
    {"Lemma 3.2, D", "max |D_h - D|", true, true,
     [](const EstimateAt& at) { return to_nonlocal(at, at.fields.u_3 / 3.0, 0.5 * at.fields.u_3); }, "h^3/delta^2"},
    {"Lemma 3.4, A", "max |A_h - d/dx|", false, false, [](const EstimateAt& at) { return 0.5 * curvature(at); }},
    {"Lemma 3.4, D", "max |reach D_h|", true, false, [](const EstimateAt& at) { return 0.5 * at.fields.u_2; }},
};

}  // namespace

constinit const ModelCard model_two = {
    .number = 2,
    .name = "Model II",
    .equations = {"(3.6)", "(3.8)", "(3.10)"},
    .left_out = "",

    .cell_weights = CellWeights::masses,
    .upwind = false,
    .viscous = true,
    .renormalized = true,
    .conserves_any_sign = true,

    .pair_cost = 4.0,
    .row_terms = 4.0,     // those of D sum to two, one with u_j and one with its neighbors, and those of A to no more
    .pde_constant = 1.0,  // both parts of Lemma 3.4, with F_zz = c u_xx
    .divergence_part = 0.25,  // B is the average of b' over half of the horizon

    .vector_form = VectorForm::symmetric,
    .continuum = &viscous_continuum,
    .make = make,
    .printed_rate = printed_rate,

    .theorems = {"Theorem 3.5", "Theorem 3.6", "Theorem 3.7"},
    .step_lemma = {.name = "Lemma 3.3",
                   .row_by_row = "Lemma 3.3, corrected",
                   .sharp = "monotone exactly up to dt mu (reach/N_j) sum_k W_k/(x_i - x_j) = 1, if mu reach >= |c| "
                            "|x_i - x_j|",
                   .where_positive = "at constant velocity",
                   .m_matrix = "an M-matrix while C dt < 1",
                   .limit = "mu",
                   .speed = [](const Scene&, double mu) { return 2.0 * mu; },
                   .enough_for_every_kernel = false},
    .to_nonlocal = "Lemma 3.2",
    .to_pde = "Lemma 3.4",
    .estimates = estimates,
    .weights = {"Remark 2.2 for Model II", "sign(k) W_k >= 0", "(3.4), first moment", "sum (x_i - x_j) W_k / N_j = 1"},
    .nearest = {"Remark 2.1 for Model II", "central difference and nearest-neighbor viscosity",
                "the central difference with viscosity", false, nearest_row},
    .mistakes = {.inconsistent = "no renormalization", .not_monotone = "no viscosity", .classical = "SPH sum"},
};

}  // namespace acstudy
