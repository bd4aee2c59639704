#include "reports/judging/uncertainty.hpp"

#include <gsl/gsl_multifit.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <memory>

namespace acstudy {

namespace {

/// Orders that differ by no more than this share of their size are taken for one.
constexpr double steady = 0.25;

bool agree(double observed, double expected) { return std::abs(observed - expected) <= steady * expected; }

/// Values against the variable, scaled so that no unit matters.
struct Data {
  std::vector<double> h, phi;
};

/// A weighted fit of phi_0 and one or two powers of h.
struct Expansion {
  double value, error, deviation, misfit;  ///< the last three at the finest level
};

Expansion expand(const Data& data, bool weighted, std::span<const double> powers, std::size_t parameters) {
  const std::size_t n = data.h.size(), columns = powers.size() + 1;
  const std::unique_ptr<gsl_matrix, decltype(&gsl_matrix_free)> matrix(gsl_matrix_alloc(n, columns), gsl_matrix_free),
      covariance(gsl_matrix_alloc(columns, columns), gsl_matrix_free);
  const std::unique_ptr<gsl_vector, decltype(&gsl_vector_free)> weights(gsl_vector_alloc(n), gsl_vector_free),
      right(gsl_vector_alloc(n), gsl_vector_free), solution(gsl_vector_alloc(columns), gsl_vector_free);
  const std::unique_ptr<gsl_multifit_linear_workspace, decltype(&gsl_multifit_linear_free)> workspace(
      gsl_multifit_linear_alloc(n, columns), gsl_multifit_linear_free);
  double sum = 0.0;
  for (const double h : data.h) sum += weighted ? 1.0 / h : 1.0;
  for (std::size_t i = 0; i < n; ++i) {
    gsl_vector_set(weights.get(), i, (weighted ? 1.0 / data.h[i] : 1.0) / sum);
    gsl_vector_set(right.get(), i, data.phi[i]);
    gsl_matrix_set(matrix.get(), i, 0, 1.0);
    for (std::size_t k = 1; k < columns; ++k) gsl_matrix_set(matrix.get(), i, k, std::pow(data.h[i], powers[k - 1]));
  }
  double residual;
  gsl_multifit_wlinear(matrix.get(), weights.get(), right.get(), solution.get(), covariance.get(), &residual,
                       workspace.get());
  Expansion fit{};
  fit.value = gsl_vector_get(solution.get(), 0);
  double error = 0.0;
  for (std::size_t k = 1; k < columns; ++k) {
    error += gsl_vector_get(solution.get(), k) * gsl_matrix_get(matrix.get(), n - 1, k);
  }
  fit.error = std::abs(error);
  fit.misfit = std::abs(data.phi.back() - fit.value - error);
  fit.deviation = std::sqrt(static_cast<double>(n) * residual / static_cast<double>(n - parameters));
  return fit;
}

/// The p of phi_0 + C h^p; 0 or 10 where it lies beyond.
double best_order(const Data& data, bool weighted) {
  const auto deviation = [&](double p) { return expand(data, weighted, std::span(&p, 1), 3).deviation; };
  constexpr double lowest = 0.02, highest = 10.0;
  constexpr int cells = 100;
  const auto place = [](int i) { return lowest + (highest - lowest) * i / cells; };
  int best = 0;
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= cells; ++i) {
    if (const double trial = deviation(place(i)); trial < smallest) {
      smallest = trial;
      best = i;
    }
  }
  if (best == 0) return 0.0;
  if (best == cells) return highest;
  return boost::math::tools::brent_find_minima(deviation, place(best - 1), place(best + 1), 50).first;
}

}  // namespace

Gci grid_convergence_index(const Difference& last, double observed, std::span<const double> pairwise, double theory,
                           bool monotone) {
  Gci gci;
  if (std::isnan(observed) || !(observed > 0.0)) return gci;
  const bool steady_pairs = pairwise.size() < 2 || agree(pairwise[pairwise.size() - 2], std::max(pairwise.back(), 0.0));
  gci.safety_factor = 3.0;
  if (!monotone) {
    gci.why = "the values swing about their limit";
  } else if (!std::isnan(theory) && !agree(observed, theory)) {
    gci.why = "the order is not theory's";
  } else if (std::isnan(theory) && !steady_pairs) {
    gci.why = "the order is not steady";
  } else {
    gci.safety_factor = 1.25;
    gci.why =
        std::isnan(theory) ? (pairwise.size() < 2 ? "three levels" : "the order is steady") : "the order is theory's";
  }
  gci.order =
      gci.safety_factor < 2.0 ? observed : std::clamp(observed, 0.5, std::max(0.5, theory > 0.0 ? theory : 2.0));
  gci.uncertainty =
      gci.safety_factor * std::abs(last.difference) / std::expm1(gci.order * std::log(last.variable / last.finer));
  return gci;
}

LeastSquaresUncertainty least_squares_uncertainty(std::span<const Value> values) {
  LeastSquaresUncertainty result;
  if (values.size() < 4) return result;
  const auto [low, high] =
      std::minmax_element(values.begin(), values.end(), [](auto& a, auto& b) { return a.value < b.value; });
  const double extent = high->value - low->value, finest = values.back().value;
  result.range = extent / static_cast<double>(values.size() - 1);
  if (!(extent > 0.0)) return result;
  Data data;
  for (const Value& value : values) {
    data.h.push_back(value.variable / values.back().variable);
    data.phi.push_back((value.value - finest) / extent);
  }

  // The power law where its order is one that second-order methods may have, else expansions of fixed order.
  struct Candidate {
    const char* name;
    std::vector<double> powers;
  };
  const Candidate first{"h", {1.0}}, second{"h^2", {2.0}}, both{"h and h^2", {1.0, 2.0}};
  double smallest = std::numeric_limits<double>::infinity();
  Expansion chosen{};
  const auto offer = [&](const Candidate& candidate, bool weighted, std::size_t parameters, double order) {
    const Expansion fit = expand(data, weighted, candidate.powers, parameters);
    if (!(fit.deviation < smallest)) return;
    smallest = fit.deviation;
    chosen = fit;
    result.weighted = weighted;
    result.expansion = candidate.name;
    result.order = order;
  };
  const double orders[] = {best_order(data, false), best_order(data, true)};
  const auto usable = [](double p) { return p >= 0.5 && p <= 2.0; };
  for (const bool weighted : {false, true}) {
    if (const double p = orders[weighted]; usable(p)) offer({"h^p", {p}}, weighted, 3, p);
  }
  if (result.expansion.empty()) {
    for (const bool weighted : {false, true}) {
      const double p = orders[weighted];
      offer(first, weighted, 2, p);
      offer(second, weighted, 2, p);
      if (p < 0.5) offer(both, weighted, 3, p);
    }
  }

  const double deviation = chosen.deviation * extent, range = result.range;
  const bool good = deviation < range;
  result.value = finest + chosen.value * extent;
  result.error = chosen.error * extent;
  result.deviation = deviation;
  result.safety_factor = good && result.order >= 0.5 && result.order < 2.1 ? 1.25 : 3.0;
  const double misfit = chosen.misfit * extent;
  result.uncertainty = good ? result.safety_factor * result.error + deviation + misfit
                            : 3.0 * deviation / range * (result.error + deviation + misfit);
  return result;
}

}  // namespace acstudy
