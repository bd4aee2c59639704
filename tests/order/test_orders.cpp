#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "reports/judging/orders.hpp"
#include "tests/catch.hpp"

using namespace acstudy;
using Catch::Matchers::WithinAbs;

namespace {

using Levels = std::vector<Level>;
constexpr double infinity = std::numeric_limits<double>::infinity(),
                 not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Refinement by ratios that are neither 2 nor equal.
const std::vector<double> uneven = {0.1, 0.071, 0.043, 0.0193, 0.011};
const std::vector<double> halved = {0.1, 0.05, 0.025, 0.0125};

template <class Error>
Levels levels(const std::vector<double>& variables, Error error) {
  Levels result;
  for (const double v : variables) result.push_back({v, error(v)});
  return result;
}

std::string verdict(const Levels& data, double theory) {
  const Judgement j = judge(data, theory);
  CHECK_FALSE(j.reason.empty());
  return std::string(name_of(j.verdict));
}

}  // namespace

TEST_CASE("a pure power is confirmed for its own order and no other") {
  for (const double p : {0.5, 1.0, 2.0, 3.0}) {
    const Levels data = levels(uneven, [p](double v) { return 0.7 * std::pow(v, p); });
    const Judgement j = judge(data, p);
    CAPTURE(p, j.reason);
    CHECK(j.verdict == Verdict::confirmed);
    CHECK_THAT(j.fitted.order, WithinAbs(p, 1e-12));
    CHECK_THAT(j.order, WithinAbs(p, 1e-6));
    CHECK_THAT(j.low, WithinAbs(p, 1e-6));
    CHECK_THAT(j.high, WithinAbs(p, 1e-6));
    CHECK_THAT(j.extrapolated, WithinAbs(p, 1e-4));
    REQUIRE(j.pairwise.size() == uneven.size() - 1);
    for (const double pair : j.pairwise) CHECK_THAT(pair, WithinAbs(p, 1e-12));
    for (const double theory : {0.5, 1.0, 2.0, 3.0}) {
      CAPTURE(theory);
      const std::string other = verdict(data, theory);
      if (theory == p) continue;
      CHECK(other == (p > theory ? "above" : "below"));
      CHECK_FALSE(meets(*verdict_from(other), Verdict::confirmed));
    }
  }
}

TEST_CASE("both bounds of the tolerance hold") {
  for (const double p : {0.96, 1.04}) {
    CHECK(verdict(levels(uneven, [p](double v) { return std::pow(v, p); }), 1.0) == "confirmed");
  }
  CHECK(verdict(levels(uneven, [](double v) { return std::pow(v, 0.94); }), 1.0) == "below");
  CHECK(verdict(levels(uneven, [](double v) { return std::pow(v, 1.06); }), 1.0) == "above");
}

TEST_CASE("orders that rise toward theory's and extrapolate to it are pre-asymptotic") {
  // Pairwise orders like those of Model I in the paper's first experiment, 0.63 to 0.94.
  const Levels data = levels(halved, [](double v) { return 0.4 * v * (1.0 - 3.9 * v); });
  const Judgement j = judge(data, 1.0);
  CAPTURE(j.reason, j.pairwise);
  CHECK(j.pairwise.front() < 0.7);
  CHECK(j.pairwise.back() > 0.8);
  CHECK(j.verdict == Verdict::pre_asymptotic);
  CHECK(meets(j.verdict, Verdict::confirmed));
  CHECK_THAT(j.extrapolated, WithinAbs(1.0, 1e-3));
  // From above as well.
  CHECK(verdict(levels(halved, [](double v) { return 0.4 * v * (1.0 + 8.0 * v); }), 1.0) == "pre-asymptotic");
  // The same data do not pass for another order.
  CHECK(verdict(data, 0.75) != "pre-asymptotic");
  CHECK(verdict(data, 1.5) == "below");
}

TEST_CASE("orders that move away from theory's are not pre-asymptotic") {
  const Judgement leaving = judge(levels(halved, [](double v) { return v + 0.02; }), 1.0);
  CAPTURE(leaving.reason);
  CHECK_FALSE(meets(leaving.verdict, Verdict::confirmed));
  // An extrapolation that happens to agree does not help orders that turn around on the way: 0.60, 0.94, 0.82.
  Levels turning = levels(halved, [](double v) { return 0.4 * v * (1.0 - 3.9 * v); });
  turning[2].error *= 0.93;
  CHECK(verdict(turning, 1.0) == "inconclusive");
  // Nor does a last order that agrees where the fit does not: 0.4, 0.4, 1 is one level off a clean order.
  const Levels late = {{0.8, 1.0}, {0.4, std::pow(2.0, -0.4)}, {0.2, std::pow(2.0, -0.8)}, {0.1, std::pow(2.0, -1.8)}};
  CHECK_THAT(judge(late, 1.0).pairwise[2], WithinAbs(1.0, 1e-12));
  CHECK(verdict(late, 1.0) == "inconclusive");
  // The slope over all levels is one, the last levels are not.
  const Levels bent = {{0.8, 1.0}, {0.4, 0.40}, {0.2, 0.16}, {0.1, 0.125}};
  CHECK_THAT(judge(bent, 1.0).fitted.order, WithinAbs(1.0, 0.1));
  CHECK_FALSE(meets(judge(bent, 1.0).verdict, Verdict::confirmed));
}

TEST_CASE("orders that rise toward a lower limit are below") {
  // order 0.8 with the same correction: approaches one no further than 0.8.
  CHECK(verdict(levels(halved, [](double v) { return std::pow(v, 0.8) * (1.0 - 3.0 * v); }), 1.0) == "below");
}

TEST_CASE("an error that is not finite is unstable, at any level") {
  for (std::size_t i = 0; i < halved.size(); ++i) {
    for (const double bad : {not_a_number, infinity, -infinity}) {
      Levels data = levels(halved, [](double v) { return v; });
      data[i].error = bad;
      CAPTURE(i, bad);
      CHECK(verdict(data, 1.0) == "unstable");
      CHECK(verdict(data, 0.0) == "unstable");
    }
  }
}

TEST_CASE("errors that are zero, negative or without refinement are inconclusive") {
  const Levels sound = levels(halved, [](double v) { return v; });
  for (std::size_t i = 0; i < halved.size(); ++i) {
    CAPTURE(i);
    Levels data = sound;
    data[i].error = -data[i].error;
    CHECK(verdict(data, 1.0) == "inconclusive");
    for (const double bad : {0.0, -0.1, not_a_number, infinity}) {
      data = sound;
      data[i].variable = bad;
      CAPTURE(bad);
      CHECK(verdict(data, 1.0) == "inconclusive");
    }
    if (i + 1 < halved.size()) {
      data = sound;
      data[i].error = 0.0;
      CHECK(verdict(data, 1.0) == "inconclusive");
      data = sound;
      data[i + 1].variable = data[i].variable;
      CHECK(verdict(data, 1.0) == "inconclusive");
    }
  }
  CHECK(verdict({sound.rbegin(), sound.rend()}, 1.0) == "inconclusive");
  CHECK(verdict({}, 1.0) == "inconclusive");
  CHECK(verdict({sound[0]}, 1.0) == "inconclusive");
  CHECK(verdict({sound[0], sound[1]}, 1.0) == "inconclusive");
  CHECK(verdict({sound[0], sound[1], sound[2]}, 1.0) == "confirmed");
}

TEST_CASE("a growing error diverges; one that explodes is unstable") {
  CHECK(verdict(levels(halved, [](double v) { return 1e-3 / v; }), 1.0) == "diverges");
  CHECK(verdict(levels(halved, [](double v) { return 1e-3 * std::pow(v, -0.1); }), 1.0) == "diverges");
  CHECK(verdict(levels(halved, [](double v) { return 1e-3 * std::pow(v, -0.01); }), 1.0) == "stagnates");
  CHECK(verdict(levels(halved, [](double v) { return 1e-3 * std::exp(2.0 / v); }), 1.0) == "unstable");
  // Converges first: the growth from the smallest error counts.
  CHECK(verdict({{0.8, 0.08}, {0.4, 0.04}, {0.2, 0.02}, {0.1, 5e5}}, 1.0) == "unstable");
  for (const double theory : {0.0, 1.0}) {
    CHECK_FALSE(meets(judge({{Level{0.4, 0.04}, {0.2, 0.02}, {0.1, 0.03}}}, theory).verdict, Verdict::confirmed));
  }
}

TEST_CASE("round-off is a floor, a settled error above it stagnates") {
  const Levels tiny = {{0.4, 1e-6}, {0.2, 1e-9}, {0.1, 1e-12}, {0.05, 4e-14}};
  CHECK(judge(tiny, 1.0, {.scale = 1.0}).verdict == Verdict::floor);
  CHECK(judge(tiny, 1.0, {.floor = 1e-13}).verdict == Verdict::floor);
  CHECK(judge(tiny, 1.0).verdict != Verdict::floor);  // whose size is not known, and which still fall
  CHECK(verdict({{0.4, 1e-2}, {0.2, 1e-6}, {0.1, 0.0}}, 1.0) == "floor");
  CHECK(verdict(levels(halved, [](double v) { return 0.01 + 1e-3 * v; }), 1.0) == "stagnates");
  CHECK(verdict(levels(halved, [](double v) { return 2e-3 + v * v; }), 2.0) == "stagnates");
}

TEST_CASE("where theory promises no convergence a settled error is what it says") {
  CHECK(verdict(levels(halved, [](double v) { return 0.01 + 1e-3 * v; }), 0.0) == "stagnates");
  CHECK(verdict(levels(halved, [](double) { return 0.01; }), 0.0) == "stagnates");
  CHECK_FALSE(judge(levels(halved, [](double v) { return v; }), 0.0).verdict == Verdict::stagnates);
  CHECK_FALSE(judge(levels(halved, [](double v) { return v; }), 0.0).verdict == Verdict::confirmed);
}

TEST_CASE("an order of 76 is no confirmation") {
  const Levels data = levels(halved, [](double v) { return std::pow(v / 0.1, 76.0) + 1e-11; });
  for (const double theory : {1.0, 2.0}) CHECK_FALSE(meets(judge(data, theory).verdict, Verdict::confirmed));
  const Levels steep = {{0.4, 1.0}, {0.3, 1e-4}, {0.2, 1e-8}, {0.15, 1e-11}};
  CHECK(judge(steep, 1.0).pairwise[0] > 20.0);
  CHECK_FALSE(meets(judge(steep, 1.0).verdict, Verdict::confirmed));
}

TEST_CASE("no refinement ratio is assumed") {
  // Halved errors on levels refined by 1.5: first order only to those who assume a ratio of 2.
  Levels data;
  for (int i = 0; i < 5; ++i) data.push_back({std::pow(1.5, -i), std::pow(2.0, -i)});
  CHECK(verdict(data, 1.0) == "above");
  CHECK(verdict(data, std::log(2.0) / std::log(1.5)) == "confirmed");
  // And the other way around.
  data.clear();
  for (int i = 0; i < 5; ++i) data.push_back({std::pow(4.0, -i), std::pow(2.0, -i)});
  CHECK(verdict(data, 1.0) == "below");
  CHECK(verdict(data, 0.5) == "confirmed");
}

TEST_CASE("a mean of pairwise orders that is theory's does not hide a wandering one") {
  const Levels data = {{0.8, 1.0}, {0.4, 0.9}, {0.2, 0.15}, {0.1, 0.125}};
  CHECK_THAT((judge(data, 1.0).pairwise[0] + judge(data, 1.0).pairwise[1] + judge(data, 1.0).pairwise[2]) / 3.0,
             WithinAbs(1.0, 1e-12));
  CHECK(verdict(data, 1.0) == "inconclusive");  // the interval is wider than any claim
}

TEST_CASE("a judgement does not depend on the units of error and variable") {
  const Levels sets[] = {
      levels(uneven, [](double v) { return v; }), levels(halved, [](double v) { return 0.4 * v * (1.0 - 3.9 * v); }),
      levels(halved, [](double v) { return 0.01 + 1e-3 * v; }), levels(halved, [](double v) { return 1e-3 / v; }),
      levels(uneven, [](double v) { return std::sqrt(v); })};
  for (const Levels& data : sets) {
    const Judgement here = judge(data, 1.0);
    for (const double error_scale : {1e-4, 1e4}) {
      for (const double variable_scale : {1e-3, 1e3}) {
        Levels scaled = data;
        for (Level& level : scaled) level = {level.variable * variable_scale, level.error * error_scale};
        const Judgement there = judge(scaled, 1.0);
        CAPTURE(error_scale, variable_scale, here.reason, there.reason);
        CHECK(there.verdict == here.verdict);
        CHECK_THAT(there.order, WithinAbs(here.order, 1e-10));
        CHECK_THAT(there.high - there.low, WithinAbs(here.high - here.low, 1e-6));
      }
    }
  }
}

TEST_CASE("the interval is Student's, with levels - 2 degrees of freedom") {
  // Three points y = 0, 1, 1 at x = 0, 1, 2 in logarithms: slope 1/2, residual 1/6, spread 2, t = 12.7062.
  const double ten = std::exp(1.0);
  const Judgement j = judge({{Level{ten * ten, ten}, {ten, ten}, {1.0, 1.0}}}, 1.0);
  CHECK_THAT(j.order, WithinAbs(0.5, 1e-12));
  CHECK_THAT(j.high - j.order, WithinAbs(12.706204736 * std::sqrt((1.0 / 6.0) / 1.0 / 2.0), 1e-6));
  CHECK_THAT(j.order - j.low, WithinAbs(j.high - j.order, 1e-12));
}

TEST_CASE("verdicts and their names go both ways") {
  for (int v = 0; v <= static_cast<int>(Verdict::inconclusive); ++v) {
    const auto one = static_cast<Verdict>(v);
    CHECK(verdict_from(name_of(one)) == one);
    CHECK(meets(one, one));
    CHECK(meets(one, Verdict::confirmed) == (one == Verdict::confirmed || one == Verdict::pre_asymptotic));
  }
  CHECK_FALSE(verdict_from("Confirmed").has_value());
  CHECK_FALSE(verdict_from("").has_value());
  CHECK_FALSE(meets(Verdict::confirmed, Verdict::pre_asymptotic));
}
