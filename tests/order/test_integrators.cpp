#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "solver/line/particles.hpp"
#include "solver/time/integrate.hpp"
#include "tests/catch.hpp"
#include "tests/general_tables.hpp"

using namespace acstudy;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr auto to_the_end = [](std::int64_t, TimeStep) { return true; };

/// u' = f(t, u), one unknown.
template <class Rate>
struct Scalar {
  Rate f;
  void rate(double t, PeriodicArray& u, std::span<double> du) const { du[0] = f(t, u[0]); }
  /// Newton's method with a difference quotient.
  void solve(double t, double scale, PeriodicArray& u) const {
    const double right = u[0];
    const auto residual = [&](double value) { return value - scale * f(t, value) - right; };
    double value = right;
    for (int i = 0; i < 30; ++i) {
      const double step = 1e-6 * std::max(1.0, std::abs(value));
      value -= residual(value) / ((residual(value + step) - residual(value - step)) / (2.0 * step));
    }
    u[0] = value;
  }
};

/// u(T) for u' = rate(t, u), u(0) = 1.
template <class Rate>
double solve(const Integrator& integrator, Rate rate, double T, std::int64_t steps) {
  PeriodicArray u(1);
  u[0] = 1.0;
  integrate(integrator, u, EqualSteps(T, steps), Scalar<Rate>{rate}, to_the_end);
  return u[0];
}

template <class Rate>
std::vector<double> observed_orders(const Integrator& integrator, Rate rate, double T, double exact) {
  std::vector<double> error, order;
  for (const std::int64_t steps : {20, 40, 80, 160, 320}) {
    error.push_back(std::abs(solve(integrator, rate, T, steps) - exact));
    if (error.size() > 1) order.push_back(std::log2(error[error.size() - 2] / error.back()));
  }
  return order;
}

const std::span<const Integrator> all_tables[] = {integrators, test::general_tables};

/// The factor of a step on u' = z u, dt = 1, straight from the table; and what is estimated of its error.
struct StepFactor {
  std::complex<double> factor, estimate;
};
StepFactor factor_of(const Integrator& integrator, std::complex<double> z) {
  std::vector<std::complex<double>> U = {1.0};
  for (std::size_t i = 1; i <= integrator.stage_count(); ++i) {
    const Stage& stage = integrator.stage(i);
    std::complex<double> sum = 0.0;
    for (std::size_t k = 0; k < i; ++k) sum += (stage.alpha[k] + stage.beta[k] * z) * U[k];
    U.push_back(sum / (1.0 - stage.beta[i] * z));
  }
  std::complex<double> estimate = 0.0;
  for (std::size_t k = 0; k < U.size(); ++k) estimate += integrator.estimate[k] * z * U[k];
  return {U.back(), estimate};
}

/// What is estimated of the error of one step of length dt from u = 1, t = 0.3.
template <class Rate>
double estimated(const Integrator& integrator, Rate rate, double dt) {
  PeriodicArray u(1);
  u[0] = 1.0;
  Scalar<Rate> system{rate};
  Stepper stepper(integrator, 1, true);
  stepper({.begin = 0.3, .end = 0.3 + dt, .dt = dt}, u, system);
  return stepper.error(1.0, u.values()) * std::max(1.0, u[0]);
}

double depends_on_time(double t, double u) { return u * std::cos(t) + std::exp(std::sin(t)); }

}  // namespace

TEST_CASE("every integrator has its declared order and no more") {
  for (const auto& tables : all_tables) {
    for (const Integrator& integrator : tables) {
      INFO(integrator.name);
      const auto check = [&](const std::vector<double>& orders) {
        CAPTURE(orders);
        // Within 0.1 for the last two of four: the next term of the error is h times smaller.
        for (std::size_t i = 2; i < orders.size(); ++i) {
          CHECK_THAT(orders[i], WithinAbs(integrator.order, 0.1));
        }
      };
      check(observed_orders(
          integrator, [](double, double u) { return -1.3 * u; }, 1.0, std::exp(-1.3)));
      // The rate depends on time: a stage at the wrong time loses an order. u = (1 + t) e^(sin t).
      check(observed_orders(integrator, depends_on_time, 1.0, 2.0 * std::exp(std::sin(1.0))));
      // Nonlinear, autonomous: u' = u^2, u = 1 / (1 - t).
      check(observed_orders(
          integrator, [](double, double u) { return u * u; }, 0.5, 2.0));
    }
  }
}

TEST_CASE("a table with a stage at the wrong time, or from the wrong rate, loses its order") {
  std::vector<Stage> late(std::begin(test::rk4_stages), std::end(test::rk4_stages)), wrong = late;
  late[1].c = 1.0;
  wrong[2].beta = {1.0};  // F_0 in place of F_2
  for (const auto& stages : {late, wrong}) {
    const std::vector<double> orders =
        observed_orders({"mistaken", 4, stages}, depends_on_time, 1.0, 2.0 * std::exp(std::sin(1.0)));
    CAPTURE(orders);
    CHECK(orders.back() < 3.1);
  }
}

TEST_CASE("the rate of a stage is taken at its time") {
  for (const auto& tables : all_tables) {
    for (const Integrator& integrator : tables) {
      for (std::size_t i = 1; i <= integrator.stage_count(); ++i) {
        const Stage& stage = integrator.stage(i);
        double u = 0.0, t = stage.beta[i];
        for (std::size_t k = 0; k < i; ++k) {
          u += stage.alpha[k];
          t += stage.alpha[k] * integrator.c(k) + stage.beta[k];
        }
        CAPTURE(integrator.name, i);
        CHECK_THAT(u, WithinAbs(1.0, 1e-15));
        CHECK_THAT(t, WithinAbs(stage.c, 1e-15));
      }
    }
  }
}

TEST_CASE("one step on u' = lambda u is the Taylor polynomial of e^z to the order of the integrator") {
  for (const Integrator& integrator : integrators) {
    if (integrator.implicit()) continue;
    for (const double z : {-1.7, -0.3, 0.4}) {
      double polynomial = 1.0, term = 1.0;
      for (int p = 1; p <= integrator.order; ++p) polynomial += term *= z / p;
      INFO(integrator.name << ", z = " << z);
      CHECK_THAT(solve(
                     integrator, [&](double, double u) { return z * u; }, 1.0, 1),
                 WithinAbs(polynomial, 1e-15));
    }
  }
}

TEST_CASE("one step on u' = lambda u is the rational function of an L-stable scheme") {
  const double g = 1.0 - std::sqrt(0.5);
  for (const double z : {-1e8, -30.0, -1.7, -0.3, 0.4}) {
    const auto rate = [&](double, double u) { return z * u; };
    CAPTURE(z);
    CHECK_THAT(solve(integrators[3], rate, 1.0, 1), WithinAbs(1.0 / (1.0 - z), 1e-13));
    CHECK_THAT(solve(integrators[4], rate, 1.0, 1),
               WithinAbs((1.0 + (1.0 - 2.0 * g) * z) / ((1.0 - g * z) * (1.0 - g * z)), 1e-13));
    const double g3 = sdirk3_gamma, w = 1.0 / (1.0 - g3 * z);
    CHECK_THAT(solve(integrators[5], rate, 1.0, 1),
               WithinAbs((1.0 + (1.0 - 3.0 * g3) * z + (0.5 - 3.0 * g3 + 3.0 * g3 * g3) * z * z) * w * w * w, 1e-13));
  }
}

TEST_CASE("implicit integrators are L-stable") {
  for (const Integrator& integrator : integrators) {
    if (!integrator.implicit()) continue;
    INFO(integrator.name);
    for (double y = 1e-3; y < 1e7; y *= 1.3) {
      CAPTURE(y);
      CHECK(std::abs(factor_of(integrator, {0.0, y}).factor) <= 1.0 + 1e-15);
    }
    for (const double z : {-1e6, -1e8, -1e10}) CHECK(std::abs(factor_of(integrator, z).factor) * -z < 10.0);
    // Of one diagonal, so that the poles are at 1/gamma > 0, and of one factorization where rates do not change.
    for (std::size_t i = 1; i <= integrator.stage_count(); ++i) CHECK(integrator.diagonal(i) == integrator.diagonal(1));
  }
}

TEST_CASE("the result of lower order has the order that it should have, and is bounded on stiff problems") {
  for (const Integrator& integrator : integrators) {
    if (!integrator.estimates()) continue;
    INFO(integrator.name);
    // sum_k d_k c_k^q is the difference of two quadratures: zero to the lower order and not beyond.
    for (int q = 0; q < integrator.order; ++q) {
      double sum = 0.0;
      for (std::size_t k = 0; k <= integrator.stage_count(); ++k)
        sum += integrator.estimate[k] * std::pow(integrator.c(k), q);
      CAPTURE(q);
      if (q < integrator.order - 1) {
        CHECK_THAT(sum, WithinAbs(0.0, 1e-15));
      } else {
        CHECK(std::abs(sum) > 0.03);
      }
    }
    // Of a step of length dt it is proportional to dt to the power of the integrator's order.
    for (const auto& rate : {+depends_on_time, +[](double, double u) { return u * u; }}) {
      const double ratio = estimated(integrator, rate, 2e-3) / estimated(integrator, rate, 1e-3);
      CHECK_THAT(std::log2(ratio), WithinAbs(integrator.order, 0.05));
    }
    for (const double z : {-0.3, 0.4}) {
      CHECK_THAT(estimated(
                     integrator, [z](double, double u) { return z * u; }, 1.0),
                 WithinAbs(std::abs(factor_of(integrator, z).estimate), 1e-13));
    }
    if (integrator.implicit()) {
      for (const double z : {-1e4, -1e8}) {
        const StepFactor stiff = factor_of(integrator, z);
        CHECK(std::abs(stiff.estimate) > 0.5);  // what a stiff part would lose is seen
        CHECK(std::abs(stiff.factor - stiff.estimate) < 2.5);
      }
    }
  }
}

TEST_CASE("explicit integrators estimate their errors by one another") {
  for (const double z : {-1.7, -0.3, 0.4}) {
    for (const int i : {1, 2}) {
      const StepFactor one = factor_of(integrators[i], z), lower = factor_of(integrators[i - 1], z);
      CHECK(std::abs(one.factor - lower.factor - one.estimate) < 1e-15);
    }
  }
}

TEST_CASE("stages are convex and taken at their times") {
  const std::vector<std::vector<double>> expected = {{0.0}, {0.0, 1.0}, {0.0, 1.0, 0.5}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    INFO(integrators[i].name);
    std::vector<double> times;
    PeriodicArray u(1);
    integrate(integrators[i], u, EqualSteps(3.0, 2),
              ExplicitSystem{[&](double t, PeriodicArray&, std::span<double> du) {
                times.push_back(t);
                du[0] = 0.0;
              }},
              to_the_end);
    std::vector<double> all;
    for (const double start : {0.0, 1.5}) {
      for (const double time : expected[i]) all.push_back(start + 1.5 * time);
    }
    CHECK(times == all);
    for (const Stage& stage : integrators[i].stages) {
      for (std::size_t k = 0; k < most_stages; ++k) {
        CHECK(stage.alpha[k] >= 0.0);
        CHECK(stage.beta[k] >= 0.0);
        CHECK(stage.beta[k] <= stage.alpha[k]);
      }
    }
  }
}

TEST_CASE("time is n dt, not a sum of steps") {
  constexpr std::int64_t steps = 1'000'000;
  double last = 0.0;
  PeriodicArray u(1);
  integrate(integrators[0], u, EqualSteps(1.0, steps),
            ExplicitSystem{[&](double t, PeriodicArray&, std::span<double> du) {
              last = t;
              du[0] = 0.0;
            }},
            to_the_end);
  // A running sum would be off by some 1e-11.
  CHECK_THAT(last, WithinAbs(1.0 - 1e-6, 1e-15));
}

TEST_CASE("steps_for takes the fewest equal steps within the bound") {
  for (const std::int64_t n : {1, 2, 3, 10, 49, 1000, 123457}) {
    for (const double bound : {0.1, 1.0 / 3.0, std::numbers::pi / 640.0, 1e-5}) {
      CAPTURE(n, bound);
      CHECK(steps_for(static_cast<double>(n) * bound, bound) == n);
      CHECK(steps_for((static_cast<double>(n) + 1e-3) * bound, bound) == n + 1);
      CHECK(steps_for((static_cast<double>(n) - 1e-3) * bound, bound) == n);
    }
  }
  CHECK(steps_for(1.0, 0.1) == 10);  // 1/0.1 > 10 in exact arithmetic of the two doubles
  CHECK(steps_for(0.3, 0.1) == 3);   // 0.3/0.1 rounds to 2.9999999999999996
  CHECK(steps_for(1.0, 5.0) == 1);
  // The paper's steps: T = 1, dt at most h / 4, h = 2 pi / 160; no multiple.
  CHECK(steps_for(1.0, 2.0 * std::numbers::pi / 640.0) == 102);
}

TEST_CASE("bounded steps stay within the bound, end at T and are never much smaller") {
  for (const double T : {1.0, 0.37, 12.5}) {
    const auto bound = [](double t) { return 0.1 / (1.0 + t * t); };
    BoundedSteps steps(T, bound);
    double end = 0.0;
    std::int64_t count = 0;
    while (const auto step = steps.next()) {
      CHECK(step->begin == end);
      CHECK(step->dt <= bound(step->begin) * (1.0 + 1e-12));
      CHECK(step->dt >= 0.5 * std::min(bound(step->begin), T));
      end = step->end;
      ++count;
    }
    CHECK(end == T);
    CHECK(count >= static_cast<std::int64_t>(10.0 * (T + T * T * T / 3.0)));
  }
  // A bound that does not change gives equal steps.
  BoundedSteps equal(1.0, [](double) { return 0.3; });
  for (int n = 0; n < 4; ++n) CHECK_THAT(equal.next()->dt, WithinRel(0.25, 1e-14));
  CHECK(!equal.next());
  BoundedSteps stuck(1.0, [](double t) { return t == 0.0 ? 0.5 : 1e-300; });
  CHECK(stuck.next());
  CHECK_THROWS_AS(stuck.next(), std::domain_error);
}

TEST_CASE("an explicit system is refused by an implicit integrator") {
  PeriodicArray u(1);
  CHECK_THROWS_AS(integrate(integrators[3], u, EqualSteps(1.0, 1),
                            ExplicitSystem{[](double, PeriodicArray&, std::span<double>) {}}, to_the_end),
                  std::logic_error);
}

TEST_CASE("the observer sees every step and can end the run") {
  for (const Integrator& integrator : integrators) {
    INFO(integrator.name);
    PeriodicArray u(1);
    u[0] = 0.0;
    std::vector<std::int64_t> seen;
    const auto one = [](double, double) { return 1.0; };
    const Scalar<decltype(one)> system{one};
    const std::int64_t done = integrate(integrator, u, EqualSteps(1.0, 10), system, [&](std::int64_t n, TimeStep) {
      seen.push_back(n);
      return n < 4;
    });
    CHECK(done == 4);
    CHECK(seen == std::vector<std::int64_t>{1, 2, 3, 4});
    CHECK_THAT(u[0], WithinRel(0.4, 1e-14));
    CHECK(integrate(integrator, u, EqualSteps(1.0, 10), system, to_the_end) == 10);
    CHECK_THAT(u[0], WithinRel(1.4, 1e-14));
  }
}

TEST_CASE("no integrator hides a value that is not finite") {
  for (const Integrator& integrator : integrators) {
    INFO(integrator.name);
    CHECK(std::isnan(solve(
        integrator, [](double t, double u) { return t > 0.3 ? std::numeric_limits<double>::quiet_NaN() : u; }, 1.0,
        10)));
  }
}
