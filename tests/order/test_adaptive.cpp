#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "solver/line/particles.hpp"
#include "solver/time/adaptive.hpp"
#include "solver/time/integrate.hpp"
#include "tests/catch.hpp"

using namespace acstudy;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// u' = lambda (u - cos t) - sin t, whose solution from u(0) = 1 is cos t, and others fall onto it like e^{lambda t}.
struct Decay {
  double lambda;
  void rate(double t, PeriodicArray& u, std::span<double> du) const {
    du[0] = lambda * (u[0] - std::cos(t)) - std::sin(t);
  }
  void solve(double t, double scale, PeriodicArray& u) const {
    u[0] = (u[0] - scale * (lambda * std::cos(t) + std::sin(t))) / (1.0 - scale * lambda);
  }
};

struct Run {
  double u = 0.0;
  std::int64_t steps = 0, rejected = 0;
  std::vector<TimeStep> stood = {};
};

Run run(const Integrator& integrator, Decay system, double T, double first, double tolerance, double start = 1.0) {
  PeriodicArray u(1);
  u[0] = start;
  Run result;
  Stepper stepper(integrator, 1, true);
  AdaptiveSteps steps(T, first, integrator.order);
  result.steps = each_adaptive_step(
      steps, [&](const TimeStep& step) { stepper(step, u, system); },
      [&] { return stepper.error(tolerance, u.values()); }, [&] { stepper.take_back(u.values()); },
      [&](std::int64_t, const TimeStep& step) {
        result.stood.push_back(step);
        return true;
      });
  result.u = u[0];
  result.rejected = steps.rejected();
  return result;
}

template <class Check>
void with_every_estimate(Check check) {
  for (const Integrator& integrator : integrators) {
    if (!integrator.estimates()) continue;
    INFO(integrator.name);
    check(integrator);
  }
}

}  // namespace

TEST_CASE("the error of adaptive steps falls with their tolerance", "[adaptive]") {
  with_every_estimate([](const Integrator& integrator) {
    std::vector<double> errors, steps;
    for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
      const Run found = run(integrator, {-1.0}, 10.0, 0.1, tolerance);
      errors.push_back(std::abs(found.u - std::cos(10.0)));
      steps.push_back(static_cast<double>(found.steps));
      CAPTURE(tolerance, errors.back(), found.steps, found.rejected);
      CHECK(errors.back() < 30.0 * tolerance);
      CHECK(found.rejected < found.steps / 4);
    }
    // A step's error is proportional to dt^order.
    const double order = std::log(1e2) / std::log(steps[2] / steps[1]);
    CHECK_THAT(order, WithinAbs(integrator.order, 0.25));
    CHECK(errors[2] < 0.05 * errors[1]);
  });
}

TEST_CASE("adaptive steps follow one another from 0 to T, the last ones alike", "[adaptive]") {
  with_every_estimate([](const Integrator& integrator) {
    for (const double T : {3.0, 0.01}) {
      const Run found = run(integrator, {-20.0}, T, 2.0, 1e-5, 2.0);
      double t = 0.0;
      for (const TimeStep& step : found.stood) {
        CHECK(step.begin == t);
        CHECK_THAT(step.end - step.begin, WithinAbs(step.dt, 1e-14));
        t = step.end;
      }
      CHECK(t == T);
      CHECK(found.steps == std::ssize(found.stood));
      if (found.steps > 1) CHECK(found.stood.back().dt > 0.15 * found.stood[found.steps - 2].dt);
    }
  });
}

TEST_CASE("a rejected step leaves nothing behind", "[adaptive]") {
  with_every_estimate([](const Integrator& integrator) {
    const Decay system{-200.0};
    const Run found = run(integrator, system, 1.0, 1.0, 1e-5, 2.0);
    CHECK(found.rejected > 0);
    PeriodicArray u(1);
    u[0] = 2.0;
    Stepper stepper(integrator, 1);
    for (const TimeStep& step : found.stood) stepper(step, u, system);
    CHECK(u[0] == found.u);
  });
}

TEST_CASE("explicit adaptive steps settle where stability limits them, implicit ones do not", "[adaptive]") {
  with_every_estimate([](const Integrator& integrator) {
    const Run found = run(integrator, {-1e4}, 1.0, 1e-3, 1e-4);
    CAPTURE(found.steps, found.rejected);
    CHECK(std::abs(found.u - std::cos(1.0)) < 1e-3);
    if (integrator.implicit()) {
      CHECK(found.steps < 100);
    } else {
      CHECK(found.steps > 3000);
      CHECK(found.steps + found.rejected < 8000);
    }
  });
}

TEST_CASE("the error of a step is over what is tolerated of it", "[adaptive]") {
  CHECK_THAT(error_over(1e-3, 1e-4, 0.2, 0.5), WithinRel(0.1));
  CHECK_THAT(error_over(1e-3, 1e-4, 10.0, 0.5), WithinRel(0.01));
  CHECK_THAT(error_over(1e-3, 1e-4, 0.2, 10.0), WithinRel(0.01));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(std::isnan(error_over(1e-3, nan, 1.0, 1.0)));
  CHECK(std::isnan(error_over(1e-3, 1.0, 1.0, nan)));
  CHECK(std::isnan(largest_of(std::vector{1.0, nan, 2.0})));
  CHECK(largest_of(std::vector{1.0, -3.0, 2.0}) == 3.0);
}

TEST_CASE("a step grows and shrinks within limits, and not after it was retried", "[adaptive]") {
  AdaptiveSteps steps(1.0, 1e-6, 2);
  CHECK(steps.next()->dt == 1e-6);
  CHECK(steps.stands(0.0));
  CHECK_THAT(steps.next()->dt, WithinRel(5e-6));
  CHECK(!steps.stands(std::numeric_limits<double>::quiet_NaN()));
  CHECK_THAT(steps.next()->dt, WithinRel(1e-6));
  CHECK(!steps.stands(1e9));
  CHECK_THAT(steps.next()->dt, WithinRel(2e-7));
  CHECK(!steps.stands(4.0));
  CHECK_THAT(steps.next()->dt, WithinRel(0.45 * 2e-7));
  CHECK(steps.stands(0.0));
  CHECK_THAT(steps.next()->dt, WithinRel(0.45 * 2e-7));
  CHECK(steps.rejected() == 3);
}

TEST_CASE("steps that no length makes tolerable end in an error", "[adaptive]") {
  AdaptiveSteps steps(1.0, 0.5, 3);
  REQUIRE(steps.next());
  REQUIRE(steps.stands(0.5));
  const auto all_rejected = [&] {
    for (int i = 0; i < 100; ++i) {
      steps.next();
      steps.stands(std::numeric_limits<double>::infinity());
    }
  };
  CHECK_THROWS_AS(all_rejected(), std::domain_error);
  CHECK(steps.rejected() < 30);
}
