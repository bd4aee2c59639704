#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "solver/time/implicit.hpp"
#include "studies/models/operator.hpp"
#include "tests/catch.hpp"
#include "tests/irregular_particles.hpp"
#include "tests/named_scene.hpp"

namespace acstudy {
namespace {

/// The matrix as it multiplies.
std::vector<double> product(const RateMatrix& R, const std::vector<double>& u) {
  std::vector<double> out(R.size(), 0.0);
  for (std::size_t j = 0; j < R.size(); ++j) {
    for (std::ptrdiff_t k = R.begin[j]; k < R.begin[j + 1]; ++k) out[j] += R.value[k] * u[R.column[k]];
  }
  return out;
}

template <class Check>
void on_every_scheme(Check check) {
  for (const char* const name : {"lee-du-2019", "standing-variable-velocity"}) {
    const auto scene = test::named_scene(name);
    for (const int model : {1, 2}) {
      for (const bool nonlocal : {false, true}) {
        for (const KernelChoice& kernel : {KernelChoice{"cubic-spline"}, KernelChoice{"power", 0.5}}) {
          check(SchemeChoice{.model = find_model(model),
                             .nonlocal_divergence = nonlocal,
                             .kernel = kernel,
                             .mu = {},
                             .control = {}},
                *scene);
        }
      }
    }
  }
}

}  // namespace

TEST_CASE("the matrix of the rates multiplies as the rates are summed", "[implicit]") {
  on_every_scheme([](const SchemeChoice& choice, const Scene& scene) {
    for (const std::size_t n : {3U, 8U, 60U}) {
      for (const double delta : {0.01, 0.5, 3.0}) {
        const auto x = test::irregular_positions(n, scene.period(), 5);
        PlacedScheme placed(choice, scene, scene.max_relative_velocity(), x, delta);
        RateMatrix R;
        placed.scheme().rows()->matrix(R);
        REQUIRE(R.size() == n);
        const auto u = test::irregular_values(n, 7);
        CAPTURE(choice.model->name, choice.nonlocal_divergence, n, delta);
        CHECK(test::relative_gap(product(R, u), placed.rate(u)) < 1e-12);
      }
    }
  });
}

TEST_CASE("an implicit step solves U - dt R U = g", "[implicit]") {
  on_every_scheme([](const SchemeChoice& choice, const Scene& scene) {
    for (const std::size_t n : {3U, 8U, 60U, 400U}) {
      for (const double dt : {1e-6, 0.1, 1e4}) {
        const auto x = test::irregular_positions(n, scene.period(), 5);
        PlacedScheme placed(choice, scene, scene.max_relative_velocity(), x, 0.5);
        RateMatrix R;
        placed.scheme().rows()->matrix(R);
        ImplicitSolver solver;
        solver.factorize(R, dt);
        const auto g = test::irregular_values(n, 7);
        std::vector<double> U = g;
        solver.solve(U);
        std::vector<double> left = placed.rate(U);
        for (std::size_t j = 0; j < n; ++j) left[j] = U[j] - dt * left[j];
        CAPTURE(choice.model->name, choice.nonlocal_divergence, n, dt);
        // Backward stable: the residual is round-off of the terms, not of the solution.
        const double scale = max_norm(g) + max_norm(U) * (1.0 + dt * placed.scheme().rows()->strongest_decay());
        for (std::size_t j = 0; j < n; ++j) CHECK(std::abs(left[j] - g[j]) < 1e-13 * scale);
      }
    }
  });
}

TEST_CASE("an implicit step of a singular or unusable matrix is refused", "[implicit]") {
  RateMatrix R;
  for (int j = 0; j < 4; ++j) {
    R.add(j, 4, j == 2 ? 1.0 : 0.0);
    R.end_row();
  }
  ImplicitSolver solver;
  CHECK_NOTHROW(solver.factorize(R, 0.5));
  CHECK_THROWS_AS(solver.factorize(R, 1.0), std::domain_error);
  R.value[2] = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(solver.factorize(R, 0.5), std::domain_error);
}

TEST_CASE("the strongest decay is what each row's own weight allows", "[implicit]") {
  on_every_scheme([](const SchemeChoice& choice, const Scene& scene) {
    const auto x = test::irregular_positions(40, scene.period(), 5);
    const double mu = scene.max_relative_velocity();
    PlacedScheme placed(choice, scene, mu, x, 0.7);
    std::vector<double> c_hat(x.size()), b(x.size(), 0.0);
    scene.c(x, c_hat);
    if (!scene.standing()) scene.b(x, b);
    double strongest = 0.0;
    for (std::size_t j = 0; j < x.size(); ++j) {
      const Stencil stencil = placed.scheme().stencil(static_cast<std::ptrdiff_t>(j));
      const double* const y = placed.particles().x.at(static_cast<std::ptrdiff_t>(j));
      double sum = 0.0, reach = 0.7;
      for (std::size_t k = 0; k < stencil.offset.size(); ++k) {
        const double z = y[stencil.offset[k]] - y[0];
        sum += choice.model == &model_two ? stencil.weight[k] / z : stencil.weight[k];
        reach = std::max(reach, std::abs(z));
      }
      strongest = std::max(strongest, choice.model == &model_two ? mu * reach / stencil.renormalization * sum
                                                                 : std::abs(c_hat[j] - b[j]) * sum);
    }
    CHECK(placed.scheme().rows()->strongest_decay() == Approx(strongest).epsilon(1e-13));
  });
}

}  // namespace acstudy
