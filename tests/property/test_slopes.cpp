#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

#include "solver/line/scheme.hpp"
#include "solver/line/slopes.hpp"
#include "tests/catch.hpp"
#include "tests/kernel_integrals.hpp"
#include "tests/model_properties.hpp"

using namespace acstudy;
using namespace acstudy::test;

static_assert(Scheme<Slopes<InverseKernel, LocalDivergence>>);
static_assert(RateSum<ClippedSlopes<InverseKernel, LocalDivergence>>);
static_assert(!KnowsItsRows<ClippedSlopes<InverseKernel, LocalDivergence>>);

namespace {

constexpr std::size_t fewest = 3;

/// Distances of the neighbors on one side by looking at all particles and their images: those within delta, `least` of
/// them always.
std::vector<Neighbor> near_images(const std::vector<double>& x, double delta, std::size_t j, int side,
                                  std::size_t least) {
  std::vector<Neighbor> all;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (int turn = -2; turn <= 2; ++turn) {
      const double distance = side * (x[i] + turn * period - x[j]);
      if (distance > 0.0 && (i != j || turn != 0)) all.push_back({i, distance});
    }
  }
  std::sort(all.begin(), all.end(), [](auto a, auto b) { return a.distance < b.distance; });
  std::size_t inside = 0;
  while (all[inside].distance <= delta * (1.0 + 1e-11)) ++inside;
  all.resize(std::max(inside, least));
  return all;
}

/// r_0 .. r_L
std::vector<double> cell_bounds(const std::vector<Neighbor>& side, double delta) {
  std::vector<double> r = {0.0};
  for (std::size_t k = 0; k + 1 < side.size(); ++k) r.push_back(0.5 * (side[k].distance + side[k + 1].distance));
  r.push_back(std::fmax(delta, side.back().distance));
  return r;
}

/// The slope by the normal equations of the quadratic, in the differences themselves.
double written_out_slope(const std::vector<double>& x, double delta, std::size_t j, const std::vector<double>& g) {
  double a11 = 0.0, a12 = 0.0, a22 = 0.0, first = 0.0, second = 0.0;
  for (const int side : {-1, 1}) {
    const auto near = near_images(x, delta, j, side, fewest);
    const auto r = cell_bounds(near, delta);
    for (std::size_t k = 0; k < near.size(); ++k) {
      const double z = side * near[k].distance, weight = r[k + 1] - r[k], p = g[near[k].index] - g[j];
      a11 += weight * z * z;
      a12 += weight * z * z * z;
      a22 += weight * z * z * z * z;
      first += weight * z * p;
      second += weight * z * z * p;
    }
  }
  return (first * a22 - second * a12) / (a11 * a22 - a12 * a12);
}

template <template <class, class> class Form>
struct SlopesTested {
  static void for_each_kernel(auto check) {
    check(std::string("inverse"), InverseKernel{});
    check(std::string("power 1.5"), PowerKernel(1.5));
    check(std::string("cubic spline"), CubicSplineKernel{});
  }
  static void for_each_divergence(auto check) {
    check(std::string("standing"), NoDivergence{});
    check(std::string("local"), LocalDivergence{});
    check(std::string("nonlocal"), NonlocalDivergence{});
  }
  template <class Divergence, class K>
  static auto placed(const K& kernel, const std::vector<double>& x, double delta, const PointwiseVelocity& v) {
    Form<K, Divergence> scheme(kernel);
    scheme.place(test::placed(x, period, delta), v);
    return scheme;
  }
  template <class Divergence, class K>
  static auto written_out(const K& kernel, const std::vector<double>& x, double delta, const PointwiseVelocity& v,
                          const std::vector<double>& u) {
    constexpr bool standing = std::is_same_v<Divergence, NoDivergence>;
    constexpr bool clipped = std::is_same_v<Form<K, Divergence>, ClippedSlopes<K, Divergence>>;
    std::vector<double> g(N), slope(N), b(N), rate(N);
    for (std::size_t j = 0; j < N; ++j) {
      g[j] = (standing ? v.c_at(x[j]) : v.c_hat_at(x[j])) * u[j];
      b[j] = v.b_at(x[j]);
    }
    for (std::size_t j = 0; j < N; ++j) slope[j] = written_out_slope(x, delta, j, g);
    for (std::size_t j = 0; j < N; ++j) {
      const int s = (standing ? v.c_at(x[j]) : v.c_hat_at(x[j])) > 0.0 ? 1 : -1;
      const auto near = near_images(x, delta, j, -s, 1);
      const auto r = cell_bounds(near, delta);
      double sum = 0.0;
      for (std::size_t k = 0; k < near.size(); ++k) {
        const std::size_t i = near[k].index;
        const double d = near[k].distance, p = g[j] - g[i];
        const double W = kernel_integral(kernel, 1, std::fmin(r[k] / delta, 1.0),
                                         k + 1 < near.size() ? std::fmin(r[k + 1] / delta, 1.0) : 1.0) /
                         d;
        double own = 0.5 * s * d * slope[j], other = 0.5 * s * d * slope[i];
        for (double* const one : {&own, &other}) {
          if (clipped) *one = std::clamp(*one, std::fmin(p, 0.0), std::fmax(p, 0.0));
        }
        sum += W * (p + own - other);
      }
      rate[j] = -s * sum;
      if (std::is_same_v<Divergence, LocalDivergence>) rate[j] -= v.b_prime_at(x[j]) * u[j];
      if (std::is_same_v<Divergence, NonlocalDivergence>) rate[j] -= written_out_slope(x, delta, j, b) * u[j];
    }
    return rate;
  }
};

/// The largest error of the rates for g = values at standing particles, where no horizon or slope crosses the period.
double worst_inside(const std::vector<double>& x, double delta, auto value, auto derivative) {
  const PointwiseVelocity v = uneven_velocity();
  std::vector<double> u;
  for (const double y : x) u.push_back(value(y) / v.c_at(y));
  auto scheme = SlopesTested<Slopes>::placed<NoDivergence>(CubicSplineKernel{}, x, delta, v);
  const auto rate = rates(scheme, u);
  double worst = 0.0;
  int checked = 0;
  for (std::size_t j = 6; j + 6 < N; ++j) {
    const double far = std::fmax(x[j + 6] - x[j], x[j] - x[j - 6]) + 2.0 * delta;
    if (x[j] - far <= x.front() || x[j] + far >= x.back()) continue;
    worst = std::fmax(worst, std::abs(rate[j] + derivative(x[j])));
    ++checked;
  }
  REQUIRE(checked > 3);
  return worst;
}

}  // namespace

TEST_CASE("weights of slopes are not negative and sum d_k W_k = 1", "[slopes]") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const auto x = irregular_positions(N, period, seed);
    SlopesTested<Slopes>::for_each_kernel([&](const std::string& name, auto kernel) {
      for (const double delta : horizons) {
        INFO(name << ", delta / h = " << delta / h << ", seed " << seed);
        const auto scheme = SlopesTested<Slopes>::placed<NoDivergence>(kernel, x, delta, uneven_velocity());
        for (std::size_t j = 0; j < N; ++j) {
          const auto near = near_images(x, delta, j, scheme.looks_left(j) ? -1 : 1, 1);
          const auto W = scheme.weights(j);
          REQUIRE(W.size() == near.size());
          double sum = 0.0;
          for (std::size_t k = 0; k < near.size(); ++k) {
            CHECK(W[k] >= 0.0);
            sum += near[k].distance * W[k];
          }
          CHECK(std::abs(sum - 1.0) < 1e-13);
        }
      }
    });
  }
}

TEST_CASE("slopes are exact for quadratics, on any particles and at any horizon", "[slopes]") {
  const auto x = irregular_positions(N, period, 4, 20.0);
  for (const double delta : {1e-6 * h, h, 4.5 * h}) {
    LeastSquaresSlopes slopes;
    slopes.place(placed(x, period, delta));
    PeriodicArray g(N);
    for (std::size_t j = 0; j < N; ++j) g[j] = 2.0 - 3.0 * x[j] + 0.7 * x[j] * x[j];
    g.wrap(slopes.reach());
    for (std::size_t j = 12; j + 12 < N; ++j) {
      INFO("delta / h = " << delta / h << ", j = " << j);
      CHECK(std::abs(slopes(j, g) - (-3.0 + 1.4 * x[j])) < 1e-10);
    }
  }
}

TEST_CASE("rates with slopes are exact where the flux is a quadratic, and not where it is a cubic", "[slopes]") {
  const auto x = irregular_positions(N, period, 5);
  for (const double delta : {1e-6 * h, 0.5 * h, 2.5 * h}) {
    INFO("delta / h = " << delta / h);
    CHECK(worst_inside(
              x, delta, [](double y) { return 1.0 - 3.0 * y + 2.0 * y * y; }, [](double y) { return -3.0 + 4.0 * y; }) <
          1e-10);
    CHECK(worst_inside(
              x, delta, [](double y) { return y * y * y; }, [](double y) { return 3.0 * y * y; }) > 1e-4);
  }
}

TEST_CASE("rates with slopes are those written out, on both sides", "[slopes]") {
  check_rates_are_those_written_out<SlopesTested<Slopes>>();
  check_rates_are_those_written_out<SlopesTested<ClippedSlopes>>();
}

TEST_CASE("slopes do not tell left from right, nor the origin of x, nor which particle is the first", "[slopes]") {
  check_left_is_like_right<SlopesTested<Slopes>>();
  check_origin_and_first_particle_are_free<SlopesTested<Slopes>>();
  check_left_is_like_right<SlopesTested<ClippedSlopes>>();
}

TEST_CASE("the matrix of slopes has their rates, also where few particles see one neighbor twice", "[slopes]") {
  for (const std::size_t count : {3u, 4u, 5u, 12u, 41u}) {
    const auto x = irregular_positions(count, period, 6);
    const auto u = irregular_values(count, 7);
    const double spacing = period / static_cast<double>(count);
    for (const double delta : {1e-6 * spacing, spacing, std::fmin(5.0 * spacing, 0.49 * period)}) {
      SlopesTested<Slopes>::for_each_divergence([&]<class Divergence>(const std::string& name, Divergence) {
        INFO(name << ", N = " << count << ", delta / h = " << delta / spacing);
        Slopes<CubicSplineKernel, Divergence> scheme(CubicSplineKernel{});
        scheme.place(placed(x, period, delta), uneven_velocity());
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

TEST_CASE("slopes keep a constant under constant c, at rest", "[slopes]") {
  const std::vector<double> x = irregular_positions(N, period, 8), constant(N, 3.0);
  SlopesTested<Slopes>::for_each_kernel([&](const std::string& name, auto kernel) {
    INFO(name);
    for (const double delta : horizons) {
      auto standing = SlopesTested<Slopes>::placed<NoDivergence>(kernel, x, delta, constant_velocity(-0.7));
      CHECK(largest(rates(standing, constant)) < 1e-12);
      auto clipped = SlopesTested<ClippedSlopes>::placed<NoDivergence>(kernel, x, delta, constant_velocity(1.0));
      CHECK(largest(rates(clipped, constant)) < 1e-12);
    }
  });
}

TEST_CASE("with a limiter a step makes no new extreme, and without one it does", "[slopes]") {
  double without = 0.0;
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    const auto x = irregular_positions(N, period, seed);
    const auto u = irregular_values(N, seed + 10);
    const double low = *std::min_element(u.begin(), u.end()), high = *std::max_element(u.begin(), u.end());
    const auto excess = [&](const std::vector<double>& rate, double dt) {
      double most = 0.0;
      for (std::size_t j = 0; j < N; ++j) {
        most = std::fmax(most, std::fmax(u[j] + dt * rate[j] - high, low - u[j] - dt * rate[j]));
      }
      return most;
    };
    for (const double delta : horizons) {
      INFO("delta / h = " << delta / h << ", seed " << seed);
      auto plain = SlopesTested<Slopes>::placed<NoDivergence>(InverseKernel{}, x, delta, constant_velocity(1.0));
      auto clipped =
          SlopesTested<ClippedSlopes>::placed<NoDivergence>(InverseKernel{}, x, delta, constant_velocity(1.0));
      const double dt = 0.5 / plain.strongest_decay();
      CHECK(excess(rates(clipped, u), dt) <= 1e-14);
      without = std::fmax(without, excess(rates(plain, u), dt));
    }
  }
  CHECK(without > 1e-2);
}

TEST_CASE("slopes count their work, and nothing of an earlier place is left", "[slopes]") {
  constexpr std::int64_t count = 20;
  const Particles particles = placed(uniform_positions(count, period), period, 4.0 * period / count);
  const auto u = irregular_values(count, 1);
  Slopes<InverseKernel, LocalDivergence> fresh(InverseKernel{}), used(InverseKernel{});
  fresh.place(particles, uneven_velocity());
  used.place(placed(irregular_positions(N, period, 1), period, 0.4 * period), constant_velocity(-2.0));
  used.place(particles, uneven_velocity());
  CHECK(rates(used, u) == rates(fresh, u));
  CHECK(fresh.work().pairs == (4 + 8) * count);
  CHECK(fresh.work().weight_builds == 1);
  CHECK(fresh.work().velocity_evaluations == 3 * count);
  CHECK(fresh.reach() == 8);
}
