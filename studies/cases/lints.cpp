#include "studies/cases/lints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "studies/models/operator.hpp"

namespace acstudy {

namespace {

constexpr std::size_t samples = 512;
/// What is below this, relative to what it is compared with, is round-off of derivatives.
constexpr double nothing = 1e-12;
constexpr double particles_per_wavelength = 8.0;
constexpr double large_source = 10.0;

double largest(const std::vector<double>& values) { return max_norm(values); }

/// Fields of a scene, with derivatives, at samples of the period; solution and source at 0, T/2 and T.
struct Fields {
  explicit Fields(const Scene& scene) : x(samples), c(samples), c_x(samples), b(samples), b_x(samples) {
    for (std::size_t i = 0; i < samples; ++i) x[i] = scene.period() * static_cast<double>(i) / samples;
    scene.c(x, c, c_x);
    if (!scene.standing()) scene.b(x, b, b_x);
    c_hat = c;
    for (std::size_t i = 0; i < samples; ++i) c_hat[i] -= b[i];
    const auto source = local_source(scene);
    source->place(x);
    std::vector<double> u(samples), u_x(samples), u_t(samples), f(samples);
    for (const double fraction : {0.0, 0.5, 1.0}) {
      const double t = fraction * scene.T();
      scene.u(x, t, u, u_x, u_t);
      source->evaluate(t, f);
      most_u = std::max(most_u, largest(u));
      most_u_x = std::max(most_u_x, largest(u_x));
      most_u_t = std::max(most_u_t, largest(u_t));
      most_f = std::max(most_f, largest(f));
      for (std::size_t i = 0; i < samples; ++i) {
        most_flux = std::max(most_flux, std::abs(c[i] * u_x[i]) + std::abs(c_x[i] * u[i]));
      }
      shortest_wave = std::max(shortest_wave, wavenumber(u));
    }
  }

  std::vector<double> x, c, c_x, b, b_x, c_hat;
  double most_u = 0.0, most_u_x = 0.0, most_u_t = 0.0, most_f = 0.0, most_flux = 0.0;
  std::size_t shortest_wave = 0;  ///< waves in a period up to which 99 % of the square of u_x are

 private:
  static std::size_t wavenumber(const std::vector<double>& u) {
    std::vector<double> energy(samples / 2, 0.0);
    double all = 0.0;
    for (std::size_t k = 1; k < energy.size(); ++k) {
      std::complex<double> sum = 0.0;
      for (std::size_t i = 0; i < samples; ++i) {
        sum += std::polar(u[i], -2.0 * std::numbers::pi * static_cast<double>(k * i % samples) / samples);
      }
      energy[k] = static_cast<double>(k * k) * std::norm(sum);
      all += energy[k];
    }
    double below = 0.0;
    for (std::size_t k = 1; k < energy.size(); ++k) {
      below += energy[k];
      if (below >= 0.99 * all) return all > 0.0 ? k : 0;
    }
    return energy.size();
  }
};

/// Terms that are zero, or the same everywhere, so that a mistake in them changes no error.
void unexercised_terms(const Study& study, const Fields& at, std::vector<std::string>& out) {
  const Scene& scene = *study.scene;
  const double rate = largest(at.c) / scene.period();
  if (largest(at.c_x) <= nothing * rate) {
    out.emplace_back("c is constant, so c' u is zero: no error shows a mistake in it; let c depend on x");
  }
  if (!scene.standing() && largest(at.b_x) <= nothing * largest(at.b) / scene.period()) {
    out.emplace_back("b is constant, so b' u is zero and both divergence forms are the same; let b depend on x");
  }
  if (at.most_u_t <= nothing * at.most_u / std::max(scene.T(), nothing)) {
    out.emplace_back("u does not depend on t, so its rate of change is never exercised; let it move");
  }
  if (at.most_u_x <= nothing * at.most_u / scene.period()) {
    out.emplace_back("u does not depend on x, so there is nothing to advect; let it vary");
  }
  const auto [low, high] = std::minmax_element(at.c_hat.begin(), at.c_hat.end());
  const bool upwind =
      std::any_of(study.series.begin(), study.series.end(), [](const Series& s) { return s.scheme.model->upwind; });
  if (upwind && (*low >= 0.0 || *high <= 0.0) && (*low != 0.0 || *high != 0.0)) {
    out.push_back(fmt::format("c - b is nowhere {}, so an upwind scheme never looks to the {}; let it change its sign",
                              *low >= 0.0 ? "negative" : "positive", *low >= 0.0 ? "right" : "left"));
  }
}

/// A scheme whose truncation error vanishes on the coarsest level, up to round-off.
void exact_solutions(const Study& study, const Fields& at, std::vector<std::string>& out) {
  constexpr std::int64_t most_particles = 4096;
  for (const Series& series : study.series) {
    const Case& coarsest = series.cases.front();
    if (series.scheme.program != nullptr || coarsest.N > most_particles || at.most_u_x == 0.0) continue;
    const auto x = uniform_positions(static_cast<std::size_t>(coarsest.N), study.scene->period());
    PlacedScheme placed(series.scheme, *study.scene, coarsest.mu, x, coarsest.delta);
    const auto source = make_source(series.scheme, *study.scene, coarsest.mu, series.nonlocal_source, coarsest.delta);
    const double error = max_norm(placed.truncation_error(*source, 0.0));
    if (error > 1e3 * nothing * std::max(largest(at.c), largest(at.b)) * at.most_u_x) continue;
    out.push_back(
        fmt::format("{} reproduces u exactly at N = {}: its errors are those of time stepping, and say nothing "
                    "of its order in space; choose another u",
                    series.label(), coarsest.N));
  }
}

void too_few_particles(const Study& study, const Fields& at, std::vector<std::string>& out) {
  std::int64_t fewest = std::numeric_limits<std::int64_t>::max();
  for (const Series& series : study.series) fewest = std::min(fewest, series.cases.front().N);
  const double waves = static_cast<double>(at.shortest_wave), ratio = static_cast<double>(fewest) / waves;
  if (study.series.empty() || ratio >= particles_per_wavelength) return;
  out.push_back(
      fmt::format("the coarsest level, N = {}, has {:.1f} particles per wavelength of u, of which there are {} "
                  "in a period; begin at N = {:.0f}, or orders take long to settle",
                  fewest, ratio, at.shortest_wave, std::ceil(particles_per_wavelength * waves)));
}

}  // namespace

std::vector<std::string> lints(const Study& study) {
  std::vector<std::string> out;
  if (study.scene == nullptr || !study.scene->solved() || study.series.empty()) return out;
  const Fields at(*study.scene);
  unexercised_terms(study, at, out);
  exact_solutions(study, at, out);
  too_few_particles(study, at, out);
  if (at.most_f > large_source * at.most_flux) {
    out.push_back(
        fmt::format("the source is up to {:.3g}, and (c u)_x, which it is to balance, {:.3g} at most: it "
                    "drives the solution, and errors of advection hardly show; let u travel about as fast as c",
                    at.most_f, at.most_flux));
  }
  return out;
}

std::vector<std::string> hidden_by_time(const Study& study, std::span<const Finding> budgets) {
  constexpr double most = 0.5;
  std::vector<std::string> out;
  for (const Finding& budget : budgets) {
    const auto of_study = [&](const Coordinate& one) {
      return one.name == "study" && one.value == Coordinate::Value(study.name);
    };
    if (std::none_of(budget.coordinates.begin(), budget.coordinates.end(), of_study)) continue;
    for (const Point& part : budget.points) {
      if (part.label != "time" || !(part.value > most)) continue;
      out.push_back(
          fmt::format("time steps make {:.0f} % of the error of {} at N = {}, by its error budget: the order observed "
                      "is not that of space; take smaller steps, or an integrator of higher order",
                      100.0 * part.value, budget.subject, part.N));
    }
  }
  return out;
}

}  // namespace acstudy
