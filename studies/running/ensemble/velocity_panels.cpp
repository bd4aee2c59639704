#include "studies/running/ensemble/velocity_panels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace acstudy {

namespace {

constexpr int nodes = 48, most_terms = 32;

/// Chebyshev coefficients a_0 .. a_47 of the polynomial through values at cos(pi (i + 1/2)/48).
std::vector<double> chebyshev_coefficients(const double* values) {
  std::vector<double> a(nodes, 0.0);
  for (int k = 0; k < nodes; ++k) {
    for (int i = 0; i < nodes; ++i) {
      // Whole turns are taken off while the angle is exact.
      const int angle = k * (2 * i + 1) % (4 * nodes);
      a[k] += values[i] * std::cos(std::numbers::pi * angle / (2 * nodes));
    }
    a[k] *= (k == 0 ? 1.0 : 2.0) / nodes;
  }
  return a;
}

/// Number of leading coefficients without which more than round-off of `scale` would be missing.
int terms_needed(const std::vector<double>& a, double scale) {
  int terms = nodes;
  while (terms > 0 && std::abs(a[terms - 1]) <= 1e-15 * scale) --terms;
  return terms;
}

/// The same polynomial in powers of t. Its coefficients fall fast, so that no digits cancel.
std::vector<double> powers(const std::vector<double>& a, int terms) {
  std::vector<double> T_before(terms, 0.0), T(terms, 0.0), sum(terms, 0.0);
  T_before[0] = 1.0;
  sum[0] = a[0];
  if (terms > 1) T[1] = 1.0;
  for (int k = 1; k < terms; ++k) {
    for (int n = 0; n < terms; ++n) sum[n] += a[k] * T[n];
    std::vector<double> T_next(terms, 0.0);
    for (int n = 0; n < terms; ++n) T_next[n] = (n > 0 ? 2.0 * T[n - 1] : 0.0) - T_before[n];
    T_before = std::exchange(T, T_next);
  }
  return sum;
}

}  // namespace

std::optional<VelocityPanels> VelocityPanels::find(const Scene& scene, double reach) {
  VelocityPanels result;
  SweepPanels& panels = result.panels_;
  // A whole number of panels, so that the last one overlaps with the first as all others do.
  panels.count = static_cast<std::ptrdiff_t>(std::max(1.0, std::ceil(scene.period() / (0.5 * reach))));
  panels.spacing = scene.period() / static_cast<double>(panels.count);
  panels.radius = 0.5 * panels.spacing + reach;

  std::vector<double> x(nodes), c(nodes), b(nodes, 0.0);
  std::vector<std::vector<double>> of_c_hat, of_b;
  double c_hat_scale = 0.0, b_scale = 0.0;
  for (std::ptrdiff_t q = 0; q < panels.count; ++q) {
    for (int i = 0; i < nodes; ++i) {
      x[i] = panels.spacing * static_cast<double>(q) + panels.radius * std::cos(std::numbers::pi * (i + 0.5) / nodes);
    }
    scene.c(x, c);
    if (!scene.standing()) scene.b(x, b);
    for (int i = 0; i < nodes; ++i) {
      c[i] -= b[i];
      c_hat_scale = std::max(c_hat_scale, std::abs(c[i]));
      b_scale = std::max(b_scale, std::abs(b[i]));
    }
    of_c_hat.push_back(chebyshev_coefficients(c.data()));
    of_b.push_back(chebyshev_coefficients(b.data()));
  }
  int terms = 1;
  for (std::ptrdiff_t q = 0; q < panels.count; ++q) {
    terms = std::max({terms, terms_needed(of_c_hat[q], c_hat_scale), terms_needed(of_b[q], b_scale)});
  }
  if (terms > most_terms || !std::isfinite(c_hat_scale + b_scale)) return std::nullopt;
  panels.terms = (terms + 3) / 4 * 4;
  for (std::ptrdiff_t q = 0; q < panels.count; ++q) {
    for (auto [coefficients, to] : {std::pair(&of_c_hat[q], &result.c_hat_), std::pair(&of_b[q], &result.b_)}) {
      const std::vector<double> polynomial = powers(*coefficients, terms);
      to->insert(to->end(), polynomial.begin(), polynomial.end());
      to->resize(to->size() + panels.terms - terms, 0.0);
    }
  }
  return result;
}

SweepPanels VelocityPanels::view() const {
  SweepPanels view = panels_;
  view.c_hat = c_hat_.data();
  view.b = b_.data();
  return view;
}

}  // namespace acstudy
