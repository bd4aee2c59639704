#include <algorithm>
#include <cmath>
#include <string>

#include "mms/quadrature.hpp"
#include "tests/catch.hpp"
#include "tests/kernel_moments.hpp"

using namespace acstudy;
using namespace acstudy::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

template <class Check>
void for_each_kernel(Check check) {
  check(std::string("inverse"), profile(InverseKernel{}), Moments(inverse_moment));
  for (const double alpha : {1.9, 1.5, 0.5, 0.0, -1.0, -2.5}) {
    check("power " + std::to_string(alpha), profile(PowerKernel(alpha)), power_moments(alpha));
  }
  check(std::string("cubic spline"), profile(CubicSplineKernel{}), Moments(spline_moment));
}

double sum(const Rule& rule, int power) {
  double value = 0.0;
  for (std::size_t i = 0; i < rule.size(); ++i) value += rule.weight[i] * std::pow(rule.node[i], power);
  return value;
}

void check_nodes(const Rule& rule) {
  CHECK(std::all_of(rule.node.begin(), rule.node.end(), [](double z) { return 0.0 < z && z < 1.0; }));
  CHECK(std::all_of(rule.weight.begin(), rule.weight.end(), [](double w) { return w > 0.0; }));
}

}  // namespace

TEST_CASE("first_moment_rule integrates z^p against z eta(z): M_{p+1}") {
  for_each_kernel([](const std::string& name, const KernelProfile& kernel, const Moments& M) {
    for (const std::size_t points : {3u, 8u, 20u}) {
      const Rule rule = first_moment_rule(kernel, points);
      INFO(name << ", " << points << " points");
      check_nodes(rule);
      // Degree 2n - 1, less the three of z times the spline's quadratic pieces.
      for (int p = 0; p <= 2 * static_cast<int>(points) - 4; ++p) {
        CAPTURE(p);
        CHECK_THAT(sum(rule, p), WithinRel(static_cast<double>(M(p + 1)), 1e-13));
      }
    }
  });
}

TEST_CASE("derivative_rule is the Gauss rule of E: moments M_{p+1} / (p + 1) up to degree 2n - 1, and no further") {
  for_each_kernel([](const std::string& name, const KernelProfile& kernel, const Moments& M) {
    for (const int points : {1, 2, 5, 12, 40}) {
      const Rule rule = derivative_rule(kernel, static_cast<std::size_t>(points));
      INFO(name << ", " << points << " points");
      REQUIRE(rule.size() == static_cast<std::size_t>(points));
      check_nodes(rule);
      for (int p = 0; p <= 2 * points - 1; ++p) {
        CAPTURE(p);
        CHECK_THAT(sum(rule, p), WithinRel(static_cast<double>(M(p + 1)) / (p + 1), 1e-12));
      }
      if (points <= 5) {
        const int p = 2 * points;
        CHECK(std::abs(sum(rule, p) / static_cast<double>(M(p + 1)) * (p + 1) - 1.0) > 1e-7);
      }
    }
  });
}

TEST_CASE("viscous_rule has moments M_{p+1} / (p + 2): total weight 1/2, degree 2n - 1") {
  for_each_kernel([](const std::string& name, const KernelProfile& kernel, const Moments& M) {
    for (const int points : {1, 2, 5, 12, 40}) {
      const Rule rule = viscous_rule(kernel, static_cast<std::size_t>(points));
      INFO(name << ", " << points << " points");
      REQUIRE(rule.size() == static_cast<std::size_t>(points));
      check_nodes(rule);
      CHECK_THAT(sum(rule, 0), WithinAbs(0.5, 1e-14));
      for (int p = 0; p <= 2 * points - 1; ++p) {
        CAPTURE(p);
        CHECK_THAT(sum(rule, p), WithinRel(static_cast<double>(M(p + 1)) / (p + 2), 1e-12));
      }
    }
  });
}

TEST_CASE("a profile is its kernel") {
  const KernelProfile spline = profile(CubicSplineKernel{}), power = profile(PowerKernel(1.5));
  CHECK(spline.breaks == std::vector{0.5});
  CHECK(spline.origin_exponent == 0.0);
  CHECK(spline.regular_part(0.3) == CubicSplineKernel{}.eta(0.3));
  CHECK(power.breaks.empty());
  CHECK(power.origin_exponent == 1.5);
  CHECK(power.regular_part(0.3) == 0.5);
}
