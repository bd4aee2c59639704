#include <cmath>
#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

#include "solver/line/model1.hpp"
#include "tests/catch.hpp"
#include "tests/kernel_integrals.hpp"
#include "tests/model_properties.hpp"

using namespace acstudy;
using Catch::Matchers::WithinRel;
using namespace acstudy::test;

// An absent part takes no storage; a present one takes that of its arrays and no more.
static_assert(sizeof(ModelI<InverseKernel, LocalDivergence>) ==
              sizeof(ModelI<InverseKernel, NoDivergence>) + sizeof(std::vector<double>));
static_assert(sizeof(ModelI<InverseKernel, NonlocalDivergence>) ==
              sizeof(ModelI<InverseKernel, NoDivergence>) + sizeof(std::vector<double>) + sizeof(PeriodicArray));

namespace {

template <class Check>
void for_each_kernel(Check check) {
  check(std::string("inverse"), InverseKernel{});
  for (const double alpha : {1.5, 0.5, 0.0, -2.0}) check("power " + std::to_string(alpha), PowerKernel(alpha));
  check(std::string("cubic spline"), CubicSplineKernel{});
}

template <class Divergence, class K>
ModelI<K, Divergence> placed_scheme(K kernel, const std::vector<double>& x, double delta, const PointwiseVelocity& v) {
  ModelI<K, Divergence> scheme(kernel);
  scheme.place(placed(x, period, delta), v);
  return scheme;
}

/// W_1 .. W_L by quadrature.
template <class K>
std::vector<double> written_out_weights(const K& kernel, const std::vector<Neighbor>& side, double delta) {
  std::vector<double> W;
  double inner = 0.0;
  for (std::size_t k = 0; k < side.size(); ++k) {
    const double outer = std::fmin(side[k].distance / delta, 1.0);
    double moment = kernel_integral(kernel, 1, inner, outer);
    if (k + 1 == side.size()) moment += kernel_integral(kernel, 1, outer, 1.0);
    W.push_back(moment / side[k].distance);
    inner = outer;
  }
  return W;
}

/// (2.4), (2.9) and (2.11) as they are printed, each side by its own formula.
template <class Divergence, class K>
std::vector<double> written_out_rates(const K& kernel, const std::vector<double>& x, double delta,
                                      const PointwiseVelocity& v, const std::vector<double>& u) {
  std::vector<double> rate(x.size());
  for (std::size_t j = 0; j < x.size(); ++j) {
    constexpr bool standing = std::is_same_v<Divergence, NoDivergence>;
    const auto c_hat = [&](std::size_t i) { return standing ? v.c_at(x[i]) : v.c_hat_at(x[i]); };
    const bool left = c_hat(j) > 0.0;
    const auto side = neighbors(x, period, delta, j, left ? -1 : +1);
    const auto W = written_out_weights(kernel, side, delta);
    double sum = 0.0;
    for (std::size_t k = 0; k < side.size(); ++k) {
      const std::size_t i = side[k].index;
      if constexpr (std::is_same_v<Divergence, NonlocalDivergence>) {
        if (left) sum += ((v.c_at(x[j]) - v.b_at(x[i])) * u[j] - c_hat(i) * u[i]) * W[k];
        if (!left) sum += ((v.b_at(x[i]) - v.c_at(x[j])) * u[j] + c_hat(i) * u[i]) * W[k];
      } else {
        if (left) sum += (c_hat(j) * u[j] - c_hat(i) * u[i]) * W[k];
        if (!left) sum += (c_hat(i) * u[i] - c_hat(j) * u[j]) * W[k];
      }
    }
    rate[j] = -sum;
    if constexpr (std::is_same_v<Divergence, LocalDivergence>) rate[j] -= v.b_prime_at(x[j]) * u[j];
  }
  return rate;
}

template <class Check>
void for_each_divergence(Check check) {
  check(std::string("(2.4)"), NoDivergence{});
  check(std::string("(2.9)"), LocalDivergence{});
  check(std::string("(2.11)"), NonlocalDivergence{});
}

struct ModelITested {
  static void for_each_kernel(auto check) { ::for_each_kernel(check); }
  static void for_each_divergence(auto check) { ::for_each_divergence(check); }
  template <class Divergence>
  static auto placed(const auto& kernel, const std::vector<double>& x, double delta, const PointwiseVelocity& v) {
    return placed_scheme<Divergence>(kernel, x, delta, v);
  }
  template <class Divergence>
  static auto written_out(const auto& kernel, const std::vector<double>& x, double delta, const PointwiseVelocity& v,
                          const std::vector<double>& u) {
    return written_out_rates<Divergence>(kernel, x, delta, v, u);
  }
};

}  // namespace

TEST_CASE("Remark 2.2: Model I's weights are not negative and sum d_k W_k = 1") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const auto x = irregular_positions(N, period, seed);
    for_each_kernel([&](const std::string& name, auto kernel) {
      for (const double delta : horizons) {
        const auto scheme = placed_scheme<NoDivergence>(kernel, x, delta, uneven_velocity());
        double worst = 0.0, least = 1.0;
        for (std::size_t j = 0; j < N; ++j) {
          const auto side = neighbors(x, period, delta, j, scheme.looks_left(j) ? -1 : +1);
          const auto W = scheme.weights(j);
          REQUIRE(W.size() == side.size());
          double sum = 0.0;
          for (std::size_t k = 0; k < side.size(); ++k) {
            sum += side[k].distance * W[k];
            least = std::fmin(least, W[k]);
          }
          worst = std::fmax(worst, std::abs(sum - 1.0));
        }
        INFO(name << ", delta / h = " << delta / h << ", seed " << seed);
        CHECK(worst < 1e-13);  // round-off of up to 35 terms
        CHECK(least >= 0.0);
      }
    });
  }
}

TEST_CASE("Remark 2.2 holds for neighbors that tie at the horizon, within its tolerance") {
  // Three neighbors on each side of particle 3, all at the horizon up to round-off, some beyond it.
  const std::vector<double> offsets = {-1.0 - 8e-12, -1.0 - 4e-12, -1.0, 0.0, 1.0, 1.0 + 4e-12, 1.0 + 8e-12};
  for_each_kernel([&](const std::string& name, auto kernel) {
    for (const double c : {1.0, -1.0}) {
      INFO(name << ", c = " << c);
      const auto scheme = placed_scheme<NoDivergence>(kernel, offsets, 1.0, constant_velocity(c));
      REQUIRE(scheme.weights(3).size() == 3);
      double sum = 0.0;
      for (const double W : scheme.weights(3)) {
        CHECK(W >= 0.0);
        sum += W;
      }
      CHECK_THAT(sum, WithinRel(1.0, 1e-10));
    }
  });
}

TEST_CASE("Remark 2.1: below every gap Model I is the upwind difference") {
  const auto x = irregular_positions(N, period, 4);
  const auto u = irregular_values(N, 5);
  const auto v = uneven_velocity();
  const auto at = [&](std::ptrdiff_t i) { return static_cast<std::size_t>((i + N) % N); };
  for_each_kernel([&](const std::string& name, auto kernel) {
    for (const double delta : {1e-9, 0.999 * gaps(x, period).smallest}) {
      auto scheme = placed_scheme<NoDivergence>(kernel, x, delta, v);
      const auto rate = rates(scheme, u);
      int lookers[2] = {0, 0};
      for (std::size_t j = 0; j < N; ++j) {
        INFO(name << ", delta = " << delta << ", j = " << j);
        const bool left = v.c_at(x[j]) > 0.0;
        ++lookers[left];
        const std::size_t i = at(static_cast<std::ptrdiff_t>(j) + (left ? -1 : 1));
        double gap = std::abs(x[i] - x[j]);
        gap = std::fmin(gap, period - gap);
        const double flux_difference = v.c_at(x[j]) * u[j] - v.c_at(x[i]) * u[i];
        CHECK_THAT(rate[j], WithinRel((left ? -1.0 : 1.0) * flux_difference / gap, 1e-12));
      }
      CHECK(lookers[0] > 3);
      CHECK(lookers[1] > 3);
    }
  });
}

TEST_CASE("Model I's rates are (2.4), (2.9) and (2.11) written out, on both sides") {
  check_rates_are_those_written_out<ModelITested>();
}

TEST_CASE("Model I does not tell left from right: x -> -x, c -> -c, b -> -b") {
  check_left_is_like_right<ModelITested>();
}

TEST_CASE("Model I does not depend on the origin of x nor on which particle is the first") {
  check_origin_and_first_particle_are_free<ModelITested>();
}

TEST_CASE("Model I keeps a constant under constant c: (2.4) at rest, (2.11) in any motion, (2.9) not") {
  check_constants_are_kept<ModelITested>();
}

TEST_CASE("where particles move with the fluid, b = c, Model I has no flux") {
  const auto x = irregular_positions(N, period, 12);
  const auto u = irregular_values(N, 13);
  PointwiseVelocity v = uneven_velocity();
  v.c_at = v.b_at;
  for (const double delta : horizons) {
    CAPTURE(delta / h);
    auto local = placed_scheme<LocalDivergence>(InverseKernel{}, x, delta, v);
    const auto rate = rates(local, u);
    for (std::size_t j = 0; j < N; ++j) CHECK(rate[j] == -v.b_prime_at(x[j]) * u[j]);
    // Without a flux, no particle feels another.
    auto nonlocal = placed_scheme<NonlocalDivergence>(InverseKernel{}, x, delta, v);
    const auto coupled = rates(nonlocal, u);
    for (std::size_t j = 0; j < N; j += 5) {
      std::vector<double> alone(N, 0.0);
      alone[j] = u[j];
      CHECK_THAT(rates(nonlocal, alone)[j], WithinRel(coupled[j], 1e-13));
    }
  }
}

TEST_CASE("Model I is exact for a linear flux, by sum d_k W_k = 1") {
  const auto x = irregular_positions(N, period, 14);
  const auto v = uneven_velocity();
  for_each_kernel([&](const std::string& name, auto kernel) {
    for (const double delta : {1e-6 * h, 2.5 * h, 7.3 * h}) {
      // c u = 1 - 3x inside the interval; particles that look across its ends are left out.
      std::vector<double> u;
      for (const double y : x) u.push_back((1.0 - 3.0 * y) / v.c_at(y));
      auto scheme = placed_scheme<NoDivergence>(kernel, x, delta, v);
      const auto rate = rates(scheme, u);
      int checked = 0;
      for (std::size_t j = 1; j + 1 < N; ++j) {
        if (x[j] - delta <= x.front() || x[j] + delta >= x.back()) continue;
        INFO(name << ", delta / h = " << delta / h << ", j = " << j);
        CHECK_THAT(rate[j], WithinRel(3.0, 1e-11));
        ++checked;
      }
      CHECK(checked > 15);
    }
  });
}

TEST_CASE("Lemma 2.4: at CFL 1 a step of Model I with constant c is a convex combination") {
  const auto x = irregular_positions(N, period, 15);
  const double h_min = gaps(x, period).smallest;
  for_each_kernel([&](const std::string& name, auto kernel) {
    for (const double delta : horizons) {
      for (const double c : {1.3, -0.8}) {
        INFO(name << ", delta / h = " << delta / h << ", c = " << c);
        auto scheme = placed_scheme<NoDivergence>(kernel, x, delta, constant_velocity(c));
        CHECK(step_norm(scheme, N, h_min / std::abs(c)) <= 1.0 + 1e-13);
      }
    }
    // Negative control: beyond CFL 1 the upwind limit loses the bound by twice the excess.
    auto upwind = placed_scheme<NoDivergence>(kernel, x, 1e-6 * h, constant_velocity(1.3));
    CHECK_THAT(step_norm(upwind, N, 1.05 * h_min / 1.3), WithinRel(1.1, 1e-10));
  });
}

TEST_CASE("Lemma 2.4: at CFL 1 a step of Model I grows by no more than the slopes of the velocities") {
  // The proof's bound: sum |c_hat_i - c_hat_j| W <= ||c_hat'||, and ||b'|| for the divergence; ||c'|| where b = 0.
  const auto v = uneven_velocity();
  const auto largest = [](auto f) {
    double value = 0.0;
    for (int i = 0; i < 10000; ++i) value = std::fmax(value, std::abs(f(period * i / 10000)));
    return value;
  };
  const auto c_prime = [](double x) { return -2.0 / 3.0 * std::sin(2.0 * x) + 0.1 * std::cos(x); };
  const double slope_c = largest(c_prime), slope_b = largest(v.b_prime_at);
  const double slope_c_hat = largest([&](double x) { return c_prime(x) - v.b_prime_at(x); });
  for (const unsigned seed : {1u, 2u, 3u}) {
    const auto x = irregular_positions(N, period, seed);
    const double h_min = gaps(x, period).smallest;
    const double dt_standing = h_min / largest(v.c_at);
    const double dt_moving = h_min / largest([&](double y) { return v.c_hat_at(y); });
    for_each_kernel([&](const std::string& name, auto kernel) {
      for (const double delta : horizons) {
        INFO(name << ", delta / h = " << delta / h << ", seed " << seed);
        auto standing = placed_scheme<NoDivergence>(kernel, x, delta, v);
        CHECK(step_norm(standing, N, dt_standing) <= 1.0 + dt_standing * slope_c + 1e-13);
        auto local = placed_scheme<LocalDivergence>(kernel, x, delta, v);
        CHECK(step_norm(local, N, dt_moving) <= 1.0 + dt_moving * (slope_b + slope_c_hat) + 1e-13);
        auto nonlocal = placed_scheme<NonlocalDivergence>(kernel, x, delta, v);
        CHECK(step_norm(nonlocal, N, dt_moving) <= 1.0 + dt_moving * (slope_b + slope_c_hat) + 1e-13);
      }
    });
    // Negative control: three times the time step breaks the bound.
    auto standing = placed_scheme<NoDivergence>(InverseKernel{}, x, 1e-6 * h, v);
    CHECK(step_norm(standing, N, 3.0 * dt_standing) > 1.0 + 3.0 * dt_standing * slope_c);
  }
}

TEST_CASE("Model I looks left exactly where c_hat > 0, and right where it vanishes") {
  const auto x = irregular_positions(N, period, 16);
  const auto v = uneven_velocity();
  const auto moving = placed_scheme<LocalDivergence>(InverseKernel{}, x, 2.0 * h, v);
  const auto standing = placed_scheme<NoDivergence>(InverseKernel{}, x, 2.0 * h, v);
  for (std::size_t j = 0; j < N; ++j) {
    CHECK(moving.looks_left(j) == (v.c_hat_at(x[j]) > 0.0));
    CHECK(standing.looks_left(j) == (v.c_at(x[j]) > 0.0));
  }
  const auto still = placed_scheme<NoDivergence>(InverseKernel{}, x, 2.0 * h, constant_velocity(0.0));
  for (std::size_t j = 0; j < N; ++j) CHECK_FALSE(still.looks_left(j));
}

TEST_CASE("Model I counts its work") {
  constexpr std::int64_t count = 20;
  const Particles particles = placed(uniform_positions(count, period), period, 3.0 * period / count);
  const auto u = irregular_values(count, 1);
  const auto work_of = [&](auto scheme) {
    scheme.place(particles, uneven_velocity());
    rates(scheme, u);
    rates(scheme, u);
    return scheme.work();
  };
  const WorkCounts standing = work_of(ModelI<InverseKernel, NoDivergence>({}));
  CHECK(standing.pairs == 2 * 3 * count);
  CHECK(standing.weight_builds == 1);
  CHECK(standing.velocity_evaluations == count);
  CHECK(work_of(ModelI<InverseKernel, LocalDivergence>({})).velocity_evaluations == 3 * count);
  CHECK(work_of(ModelI<InverseKernel, NonlocalDivergence>({})).velocity_evaluations == 2 * count);
}

TEST_CASE("a scheme can be placed again: nothing of the last place is left") {
  const auto u = irregular_values(N, 17);
  for_each_divergence([&]<class Divergence>(const std::string& equation, Divergence) {
    INFO(equation);
    ModelI<CubicSplineKernel, Divergence> used(CubicSplineKernel{});
    used.place(placed(irregular_positions(N, period, 1), period, 0.4 * period), constant_velocity(-2.0));
    rates(used, u);
    const Particles particles = placed(irregular_positions(N, period, 2), period, 2.5 * h);
    used.place(particles, uneven_velocity());
    ModelI<CubicSplineKernel, Divergence> fresh(CubicSplineKernel{});
    fresh.place(particles, uneven_velocity());
    CHECK(rates(used, u) == rates(fresh, u));
  });
}
