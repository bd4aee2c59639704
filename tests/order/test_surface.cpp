#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "reports/judging/surface.hpp"
#include "tests/catch.hpp"

using namespace acstudy;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

/// Standard normal numbers, the same on any machine: Box and Muller on the raw bits of the generator.
class Normal {
 public:
  explicit Normal(std::uint64_t seed) : bits_(seed) {}
  double operator()() {
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  double uniform() { return (static_cast<double>(bits_() >> 11) + 0.5) * 0x1p-53; }
  std::mt19937_64 bits_;
};

/// 12 horizons from 0.002 to 0.2 by 8 spacings from 0.014 to 0.16.
template <class Error>
std::vector<SurfacePoint> surface(Error error) {
  std::vector<SurfacePoint> points;
  for (int d = 0; d < 12; ++d) {
    const double delta = 0.002 * std::pow(100.0, d / 11.0);
    for (int n = 0; n < 8; ++n) {
      const double h = 0.16 * std::pow(2.0, -0.5 * n);
      points.push_back({h, delta, error(h, delta)});
    }
  }
  return points;
}

double joined(double a, double b, double m) { return std::pow(std::pow(a, m) + std::pow(b, m), 1.0 / m); }

/// Like the errors of a compatible scheme: corrections to both powers, terms that join sharply.
double compatible(double h, double delta) {
  return joined(2.3 * h * std::exp(-0.3 * h / 0.16), 0.9 * delta * std::exp(-0.2 * delta / 0.2), 7.0);
}

std::string verdict(const std::vector<SurfacePoint>& points, double theory = 1.0) {
  const Judgement judgement = judge_surface(points, theory);
  CHECK_FALSE(judgement.reason.empty());
  return std::string(name_of(judgement.verdict));
}

}  // namespace

TEST_CASE("a surface fit recovers the law that made the errors") {
  for (const double p : {0.5, 1.0, 2.0}) {
    for (const double q : {0.5, 1.0, 2.0}) {
      for (const double m : {1.0, 2.0, 8.0}) {
        CAPTURE(p, q, m);
        const auto fit = fit_surface(surface([&](double h, double delta) {
          return joined(0.1 * std::pow(h / 0.05, p) * std::exp(-0.2 * h / 0.16), 0.1 * std::pow(delta / 0.02, q), m);
        }));
        REQUIRE(fit);
        CHECK_THAT(fit->p.value, WithinAbs(p, 1e-5));
        CHECK_THAT(fit->q.value, WithinAbs(q, 1e-5));
        CHECK_THAT(fit->A, WithinRel(0.1 / std::pow(0.05, p), 1e-4));
        CHECK_THAT(fit->B, WithinRel(0.1 / std::pow(0.02, q), 1e-4));
        CHECK_THAT(fit->h_correction, WithinAbs(-0.2, 1e-4));
        CHECK_THAT(fit->delta_correction, WithinAbs(0.0, 1e-4));
        CHECK_THAT(fit->sharpness, WithinRel(m, 1e-3));
        CHECK(fit->rms < 1e-6);
        CHECK(fit->bic < std::min(fit->bic_h, fit->bic_delta) - 100.0);
        if (m > 1.0) CHECK(fit->bic < fit->sum->bic - 100.0);
      }
    }
  }
}

TEST_CASE("the plain sum of two powers recovers its own law, and shows what it cannot describe") {
  const auto fit =
      fit_surface(surface([](double h, double delta) { return 2.0 * std::pow(h, 1.5) + 0.3 * std::sqrt(delta); }));
  REQUIRE(fit);
  REQUIRE(fit->sum);
  CHECK_THAT(fit->sum->A, WithinRel(2.0, 1e-6));
  CHECK_THAT(fit->sum->B, WithinRel(0.3, 1e-6));
  CHECK_THAT(fit->sum->p.value, WithinAbs(1.5, 1e-6));
  CHECK_THAT(fit->sum->q.value, WithinAbs(0.5, 1e-6));
  CHECK(fit->sum->rms < 1e-8);
  const auto larger = fit_surface(surface([](double h, double delta) { return std::max(h, delta); }));
  REQUIRE(larger);
  REQUIRE(larger->sum);
  CHECK(larger->sum->rms > 10.0 * larger->rms);
}

TEST_CASE("the 95 % intervals of a surface's orders hold the truth in 93 to 97 % of trials") {
  constexpr int trials = 2000;
  Normal noise(20190101);
  int p_held = 0, q_held = 0, fitted = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const auto fit =
        fit_surface(surface([&](double h, double delta) { return compatible(h, delta) * std::exp(0.02 * noise()); }));
    if (!fit) continue;
    ++fitted;
    p_held += fit->p.low <= 1.0 && 1.0 <= fit->p.high;
    q_held += fit->q.low <= 1.0 && 1.0 <= fit->q.high;
  }
  CHECK(fitted == trials);
  for (const int held : {p_held, q_held}) {
    CAPTURE(p_held, q_held);
    CHECK(held >= 0.93 * trials);
    CHECK(held <= 0.97 * trials);
  }
}

TEST_CASE("a compatible scheme's surface is confirmed, for its own orders only") {
  const auto points = surface(compatible);
  CHECK(verdict(points) == "confirmed");
  CHECK(verdict(points, 2.0) == "below");
  CHECK(verdict(points, 0.5) == "above");
  CHECK(verdict(surface([](double h, double delta) { return joined(h, std::sqrt(delta), 4.0); })) == "below");
  CHECK(verdict(surface([](double h, double delta) { return joined(std::sqrt(h), delta, 4.0); })) == "below");
  CHECK(verdict(surface([](double h, double delta) { return joined(h * h, 10.0 * delta, 4.0); })) == "above");
}

TEST_CASE("a scheme that is not asymptotically compatible is not confirmed") {
  const auto scheme = [](double h, double delta) { return 0.05 * h / delta + 0.9 * delta; };
  const auto points = surface(scheme);
  CAPTURE(judge_surface(points, 1.0).reason);
  CHECK(verdict(points) != "confirmed");
  // Nor one that converges only where delta/h grows, nor one that needs h = O(delta^2).
  CHECK(verdict(surface([](double h, double delta) { return h + delta + 0.1 * std::exp(-delta / h); })) != "confirmed");
  CHECK(verdict(surface([](double h, double delta) { return 1e-3 * h / (delta * delta) + delta; })) != "confirmed");
}

TEST_CASE("a surface that takes one term, or none, is not confirmed") {
  CHECK(verdict(surface([](double h, double) { return h; })) == "inconclusive");
  CHECK(verdict(surface([](double, double delta) { return delta; })) == "inconclusive");
  CHECK(verdict(surface([](double, double) { return 0.1; })) != "confirmed");
  Normal noise(7);
  CHECK(verdict(surface([&](double h, double delta) { return compatible(h, delta) * std::exp(0.3 * noise()); })) ==
        "inconclusive");
}

TEST_CASE("what is no surface has a verdict and no fit") {
  CHECK(verdict({}) == "inconclusive");
  auto points = surface(compatible);
  points[5].error = std::nan("");
  CHECK(verdict(points) == "unstable");
  for (const double bad : {0.0, -1.0}) {
    points[5].error = bad;
    CHECK(verdict(points) == "inconclusive");
    CHECK_FALSE(fit_surface(points));
  }
  points = surface(compatible);
  points.resize(3 * 8);  // three horizons
  CHECK(verdict(points) == "inconclusive");
}
