#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <random>
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

namespace {

/// A band of random widths, up to `left` and `right`, in its rows or its columns. Its diagonal entries are below minus
/// the sums of the others, which are positive, by a margin, in each row or in each column.
RateMatrix random_band(std::size_t n, int left, int right, double margin, bool by_columns, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto count = static_cast<int>(n);
  std::vector<std::map<int, double>> rows(n);
  for (int j = 0; j < count; ++j) {
    const int l = static_cast<int>(uniform(generator) * (left + 1)),
              r = static_cast<int>(uniform(generator) * (right + 1));
    for (int k = -l; k <= r; ++k) {
      if (k == 0) continue;
      const int i = (j + k + count) % count;
      const double value = uniform(generator);
      rows[by_columns ? i : j][by_columns ? j : i] += value;
      rows[j][j] -= value * (1.0 + margin);
    }
  }
  RateMatrix R;
  for (const auto& row : rows) {
    for (const auto& [column, value] : row) R.add(column, count, value);
    R.end_row();
  }
  return R;
}

/// The solution by one of the methods.
std::vector<double> solution(const RateMatrix& R, double scale, std::vector<double> g, ImplicitSolver::Method method) {
  ImplicitSolver solver(method);
  solver.factorize(R, scale);
  solver.solve(g);
  return g;
}

void check_against_sparse(const RateMatrix& R, double scale) {
  using Method = ImplicitSolver::Method;
  const auto g = test::irregular_values(R.size(), 7);
  const auto expected = solution(R, scale, g, Method::sparse);
  CHECK(test::relative_gap(solution(R, scale, g, Method::automatic), expected) < 1e-12);
  CHECK(test::relative_gap(solution(R, scale, g, Method::pivoted), expected) < 1e-12);
}

}  // namespace

TEST_CASE("a direct solver of periodic bands agrees with a sparse one", "[implicit]") {
  unsigned seed = 0;
  for (const std::size_t n : {1U, 2U, 3U, 4U, 7U, 20U, 333U}) {
    for (const int left : {0, 1, 2, 5, 9}) {
      for (const int right : {0, 1, 2, 5, 9}) {
        if (static_cast<std::size_t>(std::max(left, right)) >= n) continue;
        for (const bool by_columns : {false, true}) {
          const RateMatrix R = random_band(n, left, right, 0.01, by_columns, ++seed);
          CAPTURE(n, left, right, by_columns);
          for (const double scale : {1e-3, 1.0, 1e3}) check_against_sparse(R, scale);
        }
      }
    }
  }
}

TEST_CASE("a band whose pivots are not on its diagonal is solved all the same", "[implicit]") {
  // The largest entry of each row is beside the diagonal, which is zero in some rows and small in others.
  for (const std::size_t n : {3U, 5U, 8U, 100U}) {
    for (const int shift : {1, 2, -3}) {
      if (static_cast<std::size_t>(2 * std::abs(shift)) >= n) continue;
      const auto small = test::irregular_values(3 * n, 11);
      RateMatrix R;
      const auto count = static_cast<int>(n);
      for (int j = 0; j < count; ++j) {
        R.add(j, count, j % 3 == 0 ? 1.0 : 1.0 - 0.1 * small[j]);
        R.add(j + shift, count, 3.0 + small[n + j]);
        R.add(j + 1, count, 0.2 * small[2 * n + j]);
        R.end_row();
      }
      CAPTURE(n, shift);
      check_against_sparse(R, 1.0);
    }
  }
}

TEST_CASE("on clustered particles the steps of every scheme are those of a sparse solver", "[implicit]") {
  on_every_scheme([](const SchemeChoice& choice, const Scene& scene) {
    constexpr std::size_t n = 200;
    // Gaps that differ by a factor of 40, so that windows do by as much.
    std::vector<double> x(n);
    for (std::size_t j = 0; j < n; ++j) {
      const double s = scene.period() * static_cast<double>(j) / n;
      x[j] =
          s - 0.95 * std::sin(2.0 * std::numbers::pi * s / scene.period()) * scene.period() / (2.0 * std::numbers::pi);
    }
    ImplicitSolver again;
    for (const double delta : {1e-6, 0.1, 0.6}) {
      PlacedScheme placed(choice, scene, scene.max_relative_velocity(), x, delta);
      RateMatrix R;
      placed.scheme().rows()->matrix(R);
      for (const double dt : {1e-3, 0.1}) {
        CAPTURE(choice.model->name, choice.nonlocal_divergence, delta, dt);
        check_against_sparse(R, dt);
        // A solver that has solved others before gives the same bits.
        auto g = test::irregular_values(n, 7);
        const auto first = solution(R, dt, g, ImplicitSolver::Method::automatic);
        again.factorize(R, dt);
        again.solve(g);
        CHECK(g == first);
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
