#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "solver/kernels.hpp"
#include "solver/line/model1.hpp"
#include "tests/catch.hpp"
#include "tests/kernel_integrals.hpp"

using namespace acstudy;
using acstudy::test::kernel_integral;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

static_assert(Kernel<InverseKernel> && !IntegrableKernel<InverseKernel>);
static_assert(Kernel<PowerKernel> && !IntegrableKernel<PowerKernel>);
static_assert(IntegrableKernel<IntegrablePowerKernel>);
static_assert(IntegrableKernel<CubicSplineKernel>);

namespace {

template <class Check>
void for_each_kernel(Check check) {
  check(std::string("inverse"), InverseKernel{});
  for (const double alpha : {1.9, 1.5, 1.0, 0.5}) check("power " + std::to_string(alpha), PowerKernel(alpha));
  for (const double alpha : {0.9, 0.5, 0.0, -1.0, -3.5}) {
    check("integrable power " + std::to_string(alpha), IntegrablePowerKernel(alpha));
  }
  check(std::string("cubic spline"), CubicSplineKernel{});
}

constexpr double arguments[] = {1e-9, 1e-3, 0.1, 0.25, 0.49999, 0.5, 0.50001, 0.75, 0.999, 1.0};

}  // namespace

TEST_CASE("every kernel has first moment one, (2.3)") {
  for_each_kernel([](const std::string& name, auto kernel) {
    INFO(name);
    CHECK(kernel.first_moment(0.0) == 0.0);
    CHECK(kernel.first_moment(1.0) == 1.0);
    // The quadrature in the test reaches 1e-12; the closed form is exact to a few units in the last place.
    CHECK_THAT(kernel_integral(kernel, 1, 0.0, 1.0), WithinRel(1.0, 1e-11));
  });
}

TEST_CASE("first_moment and mass are the integrals of z eta and eta") {
  for_each_kernel([](const std::string& name, auto kernel) {
    for (const double z : arguments) {
      INFO(name << ", z = " << z);
      CHECK_THAT(kernel.first_moment(z), WithinRel(kernel_integral(kernel, 1, 0.0, z), 1e-11));
      if constexpr (IntegrableKernel<decltype(kernel)>) {
        CHECK(kernel.mass(0.0) == 0.0);
        CHECK_THAT(kernel.mass(z), WithinRel(kernel_integral(kernel, 0, 0.0, z), 1e-11));
      }
    }
  });
}

TEST_CASE("over a cell, first_moment and mass are differences of their values at its ends") {
  for_each_kernel([](const std::string& name, auto kernel) {
    INFO(name);
    const Cell whole = CellWalk(3.0).to_horizon();
    CHECK(kernel.first_moment(whole) == 1.0);
    CellWalk cells(3.0);
    double inner = 0.0;
    for (const double outer : {0.1, 0.25, 0.3, 0.6, 0.75, 1.0}) {
      CAPTURE(outer);
      const Cell cell = outer < 1.0 ? cells.to(3.0 * outer, 3.0 * (outer - inner)) : cells.to_horizon();
      CHECK_THAT(kernel.first_moment(cell), WithinRel(kernel.first_moment(outer) - kernel.first_moment(inner), 1e-13));
      if constexpr (IntegrableKernel<decltype(kernel)>) {
        CHECK_THAT(kernel.mass(cell), WithinRel(kernel.mass(outer) - kernel.mass(inner), 1e-13));
        CHECK(kernel.mass(whole) == kernel.mass(1.0));
      }
      inner = outer;
    }
  });
}

TEST_CASE("over a cell however narrow, first_moment and mass keep their digits") {
  // The midpoint rule is exact to the square of the width over the distance, 1e-16 and less.
  for_each_kernel([](const std::string& name, auto kernel) {
    for (const double width : {1e-9, 1e-10, 1e-12}) {
      for (const double z : {0.1, 0.3, 0.5 - 0.4 * width, 0.5, 0.8}) {
        INFO(name << ", z = " << z << ", width " << width);
        const Cell cell{z, z + width, width, 1.0 - z, 1.0 - z - width};
        const double middle = z + 0.5 * width, eta = kernel.eta(middle);
        CHECK_THAT(kernel.first_moment(cell), WithinRel(middle * eta * width, 3e-15));
        if constexpr (IntegrableKernel<decltype(kernel)>) CHECK_THAT(kernel.mass(cell), WithinRel(eta * width, 3e-15));
        // Negative control: what the cells are there for.
        if (width == 1e-12) {
          CHECK(std::abs(kernel.first_moment(z + width) - kernel.first_moment(z) - middle * eta * width) >
                1e-8 * middle * eta * width);
        }
      }
    }
  });
}

TEST_CASE("a cell of neighbors that tie with the horizon ends there, and the next one is empty") {
  CellWalk cells(1.0);
  const Cell beyond = cells.to(1.0 + 8e-12, 0.25 + 8e-12), next = cells.to(1.0 + 9e-12, 1e-12);
  CHECK(beyond.outer == 1.0);
  CHECK(beyond.rest_outer == 0.0);
  CHECK(next.width == 0.0);
  for_each_kernel([&](const std::string& name, auto kernel) {
    INFO(name);
    CHECK(kernel.first_moment(next) == 0.0);
    CHECK(kernel.first_moment(cells.to_horizon()) == 0.0);
    if constexpr (IntegrableKernel<decltype(kernel)>) CHECK(kernel.mass(next) == 0.0);
  });
}

TEST_CASE("kernels are not negative and their integrals do not decrease") {
  for_each_kernel([](const std::string& name, auto kernel) {
    INFO(name);
    double moment = 0.0, mass = 0.0;
    bool nonnegative = true, monotone = true;
    for (int i = 1; i <= 2000; ++i) {
      const double z = i / 2000.0;
      nonnegative = nonnegative && kernel.eta(z) >= 0.0;
      monotone = monotone && kernel.first_moment(z) >= moment;
      moment = kernel.first_moment(z);
      if constexpr (IntegrableKernel<decltype(kernel)>) {
        monotone = monotone && kernel.mass(z) >= mass;
        mass = kernel.mass(z);
      }
    }
    CHECK(nonnegative);
    CHECK(monotone);
  });
}

TEST_CASE("the regular part is z^a eta(z) and finite at the origin") {
  for_each_kernel([](const std::string& name, auto kernel) {
    CHECK(kernel.origin_exponent() < 2.0);
    CHECK(std::isfinite(kernel.regular_part(0.0)));
    for (const double z : arguments) {
      INFO(name << ", z = " << z);
      CHECK_THAT(kernel.regular_part(z), WithinRel(std::pow(z, kernel.origin_exponent()) * kernel.eta(z), 1e-13));
    }
  });
}

TEST_CASE("a kernel is smooth away from the origin and its breakpoint") {
  // Jump of the second derivative of eta at z = 1/2: the spline's is rho''' = 3 to -1, scaled; the others have none.
  const auto second_difference = [](auto kernel, double z) {
    constexpr double h = 1e-3;
    return (kernel.eta(z + h) - 2.0 * kernel.eta(z) + kernel.eta(z - h)) / (h * h);
  };
  for_each_kernel([&](const std::string& name, auto kernel) {
    INFO(name);
    const double jump = second_difference(kernel, 0.502) - second_difference(kernel, 0.498);
    CHECK((!kernel.breaks().empty()) == (std::abs(jump) > 10.0));
    CHECK((kernel.breaks().empty() || (kernel.breaks().size() == 1 && kernel.breaks()[0] == 0.5)));
  });
}

TEST_CASE("the power family contains the inverse and the constant kernel") {
  const PowerKernel one(1.0);
  const IntegrablePowerKernel zero(0.0);
  for (const double z : arguments) {
    CAPTURE(z);
    CHECK_THAT(one.eta(z), WithinRel(InverseKernel{}.eta(z), 1e-15));
    CHECK_THAT(one.first_moment(z), WithinRel(InverseKernel{}.first_moment(z), 1e-15));
    CHECK(zero.eta(z) == 2.0);
    CHECK_THAT(zero.mass(z), WithinRel(2.0 * z, 1e-15));
  }
}

TEST_CASE("the spline kernel is -8 rho'(2z) of the printed B-spline") {
  const CubicSplineKernel spline;
  for (const double z : {0.01, 0.1, 0.25, 0.4, 0.6, 0.75, 0.9, 0.99}) {
    CAPTURE(z);
    // A fourth-order difference is exact for a cubic: round-off, 1e-16 / h, is all there is.
    constexpr double h = 1e-3;
    const double zeta = 2.0 * z;
    const double slope =
        (8.0 * (test::rho(zeta + h) - test::rho(zeta - h)) - (test::rho(zeta + 2.0 * h) - test::rho(zeta - 2.0 * h))) /
        (12.0 * h);
    CHECK_THAT(spline.eta(z), WithinAbs(-8.0 * slope, 1e-11));
    CHECK_THAT(spline.mass(z), WithinAbs(4.0 * (test::rho(0.0) - test::rho(zeta)), 1e-14));
  }
}

TEST_CASE("kernels without a first moment, or without a mass for Model II, are refused") {
  constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const double alpha : {2.0, 2.5, infinity, -infinity, nan}) {
    CAPTURE(alpha);
    CHECK_THROWS_AS(PowerKernel(alpha), std::invalid_argument);
    CHECK_THROWS_AS(IntegrablePowerKernel(alpha), std::invalid_argument);
  }
  for (const double alpha : {1.0, 1.5}) {
    CAPTURE(alpha);
    CHECK_NOTHROW(PowerKernel(alpha));
    CHECK_THROWS_AS(IntegrablePowerKernel(alpha), std::invalid_argument);
  }
  CHECK_NOTHROW(PowerKernel(std::nextafter(2.0, 0.0)));
  CHECK_NOTHROW(IntegrablePowerKernel(std::nextafter(1.0, 0.0)));
  CHECK_THROWS_WITH(PowerKernel(2.0), "power kernel needs a finite alpha < 2");
  CHECK_THROWS_WITH(IntegrablePowerKernel(1.0), "integrable power kernel needs alpha < 1");
}
