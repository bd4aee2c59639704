#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "solver/line/scheme.hpp"
#include "solver/line/symmetric.hpp"
#include "solver/time/integrate.hpp"
#include "solver/time/steps.hpp"
#include "tests/catch.hpp"
#include "tests/model_properties.hpp"

using namespace acstudy;
using namespace acstudy::test;

static_assert(Scheme<Symmetric<CubicSplineKernel, NoDivergence>>);

namespace {

struct SymmetricTested {
  static constexpr double mu = 1.7;
  static void for_each_kernel(auto check) {
    check(std::string("cubic spline"), CubicSplineKernel{});
    check(std::string("power 0.5"), IntegrablePowerKernel(0.5));
    check(std::string("power -2"), IntegrablePowerKernel(-2.0));
  }
  static void for_each_divergence(auto check) {
    check(std::string("standing"), NoDivergence{});
    check(std::string("local"), LocalDivergence{});
    check(std::string("nonlocal"), NonlocalDivergence{});
  }
  template <class Divergence, class K>
  static auto placed(const K& kernel, const std::vector<double>& x, double delta, const PointwiseVelocity& v) {
    Symmetric<K, Divergence> scheme(kernel, mu);
    scheme.place(test::placed(x, period, delta), v);
    return scheme;
  }
};

/// beta_ij by the midpoint rule over cell i of the integrals over cell j.
double written_out_beta(const auto& kernel, double delta, double low_i, double high_i, double low_j, double high_j) {
  constexpr int points = 4000;
  const auto mass = [&](double distance) { return kernel.mass(std::fmin(distance / delta, 1.0)) / delta; };
  double sum = 0.0;
  for (int k = 0; k < points; ++k) {
    const double y = low_i + (high_i - low_i) * (k + 0.5) / points;
    sum += mass(high_j - y) - mass(low_j - y);
  }
  return sum * (high_i - low_i) / points;
}

}  // namespace

TEST_CASE("V_j is the spacing on equal gaps, at any horizon", "[symmetric]") {
  SymmetricTested::for_each_kernel([&](const std::string& name, auto kernel) {
    for (const double delta : horizons) {
      INFO(name << ", delta / h = " << delta / h);
      const auto scheme =
          SymmetricTested::placed<NoDivergence>(kernel, uniform_positions(N, period), delta, constant_velocity(1.0));
      for (const double V : scheme.volumes()) CHECK(std::abs(V - h) < 1e-12 * h);
    }
  });
}

TEST_CASE("weights of the symmetric scheme are integrals over two cells", "[symmetric]") {
  const auto x = irregular_positions(N, period, 1);
  SymmetricTested::for_each_kernel([&](const std::string& name, auto kernel) {
    for (const double delta : {0.5 * h, 2.5 * h, 7.3 * h}) {
      INFO(name << ", delta / h = " << delta / h);
      const auto scheme = SymmetricTested::placed<NoDivergence>(kernel, x, delta, constant_velocity(1.0));
      const std::vector<double> W = scheme.weights(20);
      const auto first = static_cast<std::size_t>(scheme.neighbors_left(20));
      double sum = 0.0;
      for (std::size_t k = 0; k < W.size(); ++k)
        sum += W[k] * (k < first ? x[20 - first + k] - x[20] : x[21 - first + k] - x[20]);
      CHECK(std::abs(sum - 2.0) < 1e-13);
      // What it sees of a neighbor, the neighbor sees of it.
      const std::vector<double> of_neighbor = scheme.weights(19);
      CHECK(std::abs(W[first - 1] * scheme.volumes()[20] +
                     of_neighbor[static_cast<std::size_t>(scheme.neighbors_left(19))] * scheme.volumes()[19]) < 1e-15);
      const auto bound = [&](std::size_t j) { return 0.5 * (x[j] + x[j + 1]); };
      double most = 0.0;
      for (std::size_t k = 0; first + k < W.size(); ++k) {
        const double beta = written_out_beta(kernel, delta, bound(19), bound(20), bound(20 + k), bound(21 + k));
        CHECK(std::abs(W[first + k] * scheme.volumes()[20] - beta) < 1e-3 * beta + 1e-6);
        most += W[first + k] * scheme.volumes()[20];
      }
      // No cell within the horizon is left out: all of them and one more have what the counted ones have.
      const std::size_t count = W.size() - first;
      const double missing =
          written_out_beta(kernel, delta, bound(19), bound(20), bound(20 + count), bound(23 + count));
      CHECK(missing < 1e-12 * most);
    }
  });
}

TEST_CASE("the symmetric scheme conserves sum V u to round-off, and with the local divergence only that of its sums",
          "[symmetric]") {
  const auto v = uneven_velocity();
  for (const unsigned seed : {1u, 2u, 3u}) {
    const auto x = irregular_positions(N, period, seed, 50.0);
    const auto u = irregular_values(N, seed + 10);
    SymmetricTested::for_each_kernel([&](const std::string& name, auto kernel) {
      for (const double delta : horizons) {
        INFO(name << ", delta / h = " << delta / h << ", seed " << seed);
        const auto total = [](const std::vector<double>& rate, auto factor) {
          double sum = 0.0, size = 0.0;
          for (std::size_t j = 0; j < N; ++j) {
            sum += factor(j) * rate[j];
            size += std::abs(factor(j) * rate[j]);
          }
          return std::abs(sum) / size;
        };
        auto standing = SymmetricTested::placed<NoDivergence>(kernel, x, delta, v);
        CHECK(total(rates(standing, u), [&](std::size_t j) { return standing.volumes()[j]; }) < 1e-14);
        auto carried = SymmetricTested::placed<NonlocalDivergence>(kernel, x, delta, v);
        CHECK(total(rates(carried, u), [](std::size_t) { return 1.0; }) < 1e-14);
        auto local = SymmetricTested::placed<LocalDivergence>(kernel, x, delta, v);
        auto sums = rates(local, u);
        CHECK(total(sums, [&](std::size_t j) { return local.volumes()[j]; }) > 1e-6);
        for (std::size_t j = 0; j < N; ++j) sums[j] += v.b_prime_at(x[j]) * u[j];
        CHECK(total(sums, [&](std::size_t j) { return local.volumes()[j]; }) < 1e-14);
      }
    });
  }
}

TEST_CASE("sum V u of moving particles stays what it is over a run, to round-off", "[symmetric]") {
  const std::vector<double> start = irregular_positions(N, period, 9), u = irregular_values(N, 10);
  PointwiseVelocity v = uneven_velocity();
  // Conservation does not ask whether particles follow b.
  v.b_at = [](double) { return 0.4; };
  v.b_prime_at = [](double) { return 0.0; };
  struct Moving {
    Symmetric<CubicSplineKernel, NonlocalDivergence> scheme{CubicSplineKernel{}, SymmetricTested::mu};
    const PointwiseVelocity& velocity;
    const std::vector<double>& start;
    void place(double t) {
      std::vector<double> x = start;
      for (double& value : x) value += 0.4 * t + 0.3 * h * std::sin(3.0 * value) * std::sin(t);
      scheme.place(placed(x, period, 2.5 * h), velocity);
    }
    void rate(double t, PeriodicArray& unknown, std::span<double> out) {
      place(t);
      scheme.rate(unknown, out);
    }
  };
  Moving moving{.velocity = v, .start = start};
  moving.place(0.0);
  PeriodicArray unknown = periodic(u);
  for (std::size_t j = 0; j < N; ++j) unknown.values()[j] *= moving.scheme.volumes()[j];
  const auto sum = [&] { return std::accumulate(unknown.values().begin(), unknown.values().end(), 0.0); };
  const double before = sum();
  const auto changed = unknown[3];
  integrate(integrators[2], unknown, EqualSteps(1.0, 200), moving, [](std::int64_t, const TimeStep&) { return true; });
  CHECK(std::abs(sum() - before) < 1e-14 * period);
  CHECK(std::abs(unknown[3] - changed) > 1e-3 * h);
}

TEST_CASE("under constant c the symmetric scheme keeps constants, and sum V u^2 does not grow", "[symmetric]") {
  const auto x = irregular_positions(N, period, 4, 50.0);
  const auto u = irregular_values(N, 5);
  SymmetricTested::for_each_kernel([&](const std::string& name, auto kernel) {
    for (const double delta : horizons) {
      INFO(name << ", delta / h = " << delta / h);
      const auto energy_rate = [&](auto& scheme) {
        const auto rate = rates(scheme, u);
        double sum = 0.0, size = 0.0;
        for (std::size_t j = 0; j < N; ++j) {
          sum += scheme.volumes()[j] * u[j] * rate[j];
          size += std::abs(scheme.volumes()[j] * u[j] * rate[j]);
        }
        return sum / size;
      };
      auto scheme = SymmetricTested::placed<NoDivergence>(kernel, x, delta, constant_velocity(-0.8));
      const double fastest = largest(rates(scheme, u));
      CHECK(largest(rates(scheme, std::vector<double>(N, 3.0))) < 1e-10 * fastest);
      CHECK(energy_rate(scheme) < 0.0);
      // Without viscosity it stays what it is.
      using K = decltype(kernel);
      Symmetric<K, NoDivergence> inviscid(kernel, 0.0);
      inviscid.place(placed(x, period, delta), constant_velocity(-0.8));
      CHECK(std::abs(energy_rate(inviscid)) < 1e-10);
    }
  });
}

TEST_CASE("the symmetric scheme does not tell left from right, nor the origin of x, nor which particle is the first",
          "[symmetric]") {
  check_left_is_like_right<SymmetricTested>();
  check_origin_and_first_particle_are_free<SymmetricTested>();
}

TEST_CASE("the matrix of the symmetric scheme has its rates, also where few particles see one neighbor twice",
          "[symmetric]") {
  for (const std::size_t count : {3u, 4u, 5u, 12u, 41u}) {
    const auto x = irregular_positions(count, period, 6);
    const auto u = irregular_values(count, 7);
    const double spacing = period / static_cast<double>(count);
    for (const double delta : {1e-6 * spacing, spacing, std::fmin(5.0 * spacing, 0.49 * period)}) {
      SymmetricTested::for_each_divergence([&]<class Divergence>(const std::string& name, Divergence) {
        INFO(name << ", N = " << count << ", delta / h = " << delta / spacing);
        auto scheme = SymmetricTested::placed<Divergence>(CubicSplineKernel{}, x, delta, uneven_velocity());
        RateMatrix R;
        scheme.matrix(R);
        REQUIRE(R.size() == count);
        std::vector<double> product(count, 0.0);
        for (std::size_t j = 0; j < count; ++j) {
          for (std::ptrdiff_t e = R.begin[j]; e < R.begin[j + 1]; ++e) product[j] += R.value[e] * u[R.column[e]];
        }
        CHECK(relative_gap(product, rates(scheme, u)) < 1e-13);
      });
    }
  }
}
