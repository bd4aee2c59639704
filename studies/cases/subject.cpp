#include "studies/cases/subject.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace acstudy {

std::vector<std::vector<double>> Subject::positions(std::int64_t N) const {
  std::vector<std::vector<double>> all;
  for (unsigned seed = 1; seed <= (arrangement == Arrangement::jittered ? seeds : 1); ++seed) {
    all.push_back(arrange(arrangement, *scene, static_cast<std::size_t>(N), seed));
  }
  return all;
}

std::vector<Coordinate> scheme_coordinates(const SchemeChoice& scheme, double mu, bool standing) {
  std::vector<Coordinate> all = {{"model", static_cast<double>(scheme.model), fmt::format("model {}", scheme.model)},
                                 {"kernel", scheme.kernel.label()}};
  if (!standing) all.emplace_back("divergence", scheme.nonlocal_divergence ? "nonlocal" : "local");
  if (scheme.model == 2) all.emplace_back("mu", mu, fmt::format("mu = {}", mu));
  if (!scheme.control.empty()) all.emplace_back("control", scheme.control);
  for (Coordinate& one : all) one.spoken = false;
  return all;
}

Check Subject::check(std::string statement, std::string claim, const std::vector<Coordinate>& conditions,
                     std::string quantity, Test test) const {
  std::vector<Coordinate> coordinates = {{"arrangement", std::string(name_of(arrangement))}};
  coordinates.insert(coordinates.end(), conditions.begin(), conditions.end());
  const std::vector<Coordinate> of_scheme = scheme_coordinates(scheme, mu, scene->standing());
  coordinates.insert(coordinates.end(), of_scheme.begin(), of_scheme.end());
  const Verdict good = test == Test::order ? Verdict::confirmed : Verdict::holds;
  return {.statement = std::move(statement),
          .claim = std::move(claim),
          .subject = scheme_label(scheme, scene->standing()),
          .coordinates = std::move(coordinates),
          .quantity = std::move(quantity),
          .test = test,
          .variable = "h",
          .promised = good,
          .expected = good};
}

std::vector<double> Resolutions::deltas(std::int64_t count, double period) const {
  std::vector<double> all;
  const double h = period / static_cast<double>(count);
  for (const double ratio : ratios) all.push_back(ratio * h);
  all.insert(all.end(), horizons.begin(), horizons.end());
  std::erase_if(all, [&](double delta) { return delta >= 0.5 * period; });
  return all;
}

FieldBounds field_bounds(const Scene& scene, double t) {
  constexpr std::size_t count = 4096;
  const std::vector<double> x = uniform_positions(count, scene.period());
  const auto derivative = [&](const std::vector<double>& f) {
    std::vector<double> slope(count);
    const double width = 2.0 * scene.period() / count;
    for (std::size_t i = 0; i < count; ++i) slope[i] = (f[(i + 1) % count] - f[(i + count - 1) % count]) / width;
    return slope;
  };
  const auto bound = [](const std::vector<double>& f) { return 1.001 * max_norm(f); };
  std::vector<double> c_hat(count), c_hat_1(count), b(count), b_1(count), u(count), u_1(count), flux_1(count);
  scene.c(x, c_hat, c_hat_1);
  if (!scene.standing()) scene.b(x, b, b_1);
  scene.u(x, t, u, u_1);
  for (std::size_t i = 0; i < count; ++i) {
    c_hat[i] -= b[i];
    c_hat_1[i] -= b_1[i];
    flux_1[i] = c_hat_1[i] * u[i] + c_hat[i] * u_1[i];
  }
  const std::vector<double> u_2 = derivative(u_1);
  return {.c_hat = bound(c_hat),
          .c_hat_1 = bound(c_hat_1),
          .c_hat_2 = bound(derivative(c_hat_1)),
          .b_1 = bound(b_1),
          .b_2 = bound(derivative(b_1)),
          .u = bound(u),
          .u_1 = bound(u_1),
          .u_2 = bound(u_2),
          .u_3 = bound(derivative(u_2)),
          .flux_2 = bound(derivative(flux_1))};
}

}  // namespace acstudy
