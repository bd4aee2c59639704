#include "studies/models/operator.hpp"

#include <algorithm>
#include <cmath>

namespace acstudy {

PlacedScheme::PlacedScheme(const SchemeChoice& choice, const Scene& scene, double mu, const std::vector<double>& x,
                           double delta)
    : PlacedScheme(make_scheme(choice, scene, mu), scene, x, delta) {}

PlacedScheme::PlacedScheme(std::unique_ptr<LineScheme> scheme, const Scene& scene, const std::vector<double>& x,
                           double delta)
    : scene_(scene), particles_(x.size(), scene.period(), delta), scheme_(std::move(scheme)) {
  particles_.place(x);
  scheme_->place(particles_);
}

std::vector<double> PlacedScheme::rate(const std::vector<double>& values) {
  PeriodicArray u(values.size());
  std::copy(values.begin(), values.end(), u.values().begin());
  std::vector<double> du(values.size());
  scheme_->rate(u, du);
  return du;
}

std::vector<double> PlacedScheme::truncation_error(Source& source, double t) {
  const auto x = particles_.x.values();
  std::vector<double> u(size()), u_x(size()), u_t(size()), f(size()), b(size(), 0.0);
  scene_.u(x, t, u, u_x, u_t);
  if (!scene_.standing()) scene_.b(x, b);
  source.place(x);
  source.evaluate(t, f);
  std::vector<double> error = rate(u);
  for (std::size_t j = 0; j < size(); ++j) error[j] += f[j] - (u_t[j] + b[j] * u_x[j]);
  return error;
}

PlacedScheme::Rows PlacedScheme::rows() {
  const auto n = static_cast<std::ptrdiff_t>(size());
  const std::ptrdiff_t reach = std::min<std::ptrdiff_t>(scheme_->reach(), n);
  const bool banded = 2 * reach + 1 < n;
  const std::ptrdiff_t width = banded ? 2 * reach + 1 : n, first = banded ? -reach : 0;
  Rows rows{first, static_cast<std::size_t>(width), std::vector<double>(static_cast<std::size_t>(n * width))};
  std::vector<double> probe(size());
  // Columns i, i + width, ... do not meet in any row. The columns of the last, incomplete stretch are probed alone.
  const std::ptrdiff_t whole = banded ? n / width * width : 0;
  const auto take = [&](std::ptrdiff_t column, std::ptrdiff_t stride, std::ptrdiff_t end) {
    std::fill(probe.begin(), probe.end(), 0.0);
    for (std::ptrdiff_t i = column; i < end; i += stride) probe[static_cast<std::size_t>(i)] = 1.0;
    const std::vector<double> du = rate(probe);
    for (std::ptrdiff_t i = column; i < end; i += stride) {
      for (std::ptrdiff_t k = 0; k < width; ++k) {
        // Row j has column i at entry k: i = j + first + k.
        const std::ptrdiff_t j = ((i - first - k) % n + n) % n;
        rows.entry[static_cast<std::size_t>(j * width + k)] = du[static_cast<std::size_t>(j)];
      }
    }
  };
  for (std::ptrdiff_t column = 0; column < (banded ? std::min(width, whole) : 0); ++column) take(column, width, whole);
  for (std::ptrdiff_t column = whole; column < n; ++column) take(column, n, n);
  return rows;
}

double step_norm(PlacedScheme& placed, double dt) {
  const PlacedScheme::Rows rows = placed.rows();
  const auto diagonal = static_cast<std::size_t>(-rows.first);
  std::vector<double> sums(placed.size(), 0.0);
  for (std::size_t j = 0; j < placed.size(); ++j) {
    for (std::size_t k = 0; k < rows.width; ++k) sums[j] += std::abs((k == diagonal ? 1.0 : 0.0) + dt * rows(j, k));
  }
  return max_norm(sums);
}

double max_norm(const std::vector<double>& values) {
  double largest = 0.0;
  // Once NaN, it stays: no comparison with a NaN is true.
  for (const double value : values) {
    if (std::isnan(value) || std::abs(value) > largest) largest = std::abs(value);
  }
  return largest;
}

}  // namespace acstudy
