/// Work counts against the closed forms of the paper's flow, x' = sin(x), whose inverse is known.

#include <atomic>
#include <cmath>
#include <numbers>
#include <string>

#include "studies/kinds/study_file.hpp"
#include "studies/running/run_case.hpp"
#include "tests/catch.hpp"

namespace acstudy {
namespace {

constexpr double pi = std::numbers::pi;

Case paper_case(int model, const std::string& delta, int N) {
  const std::string kernel = model == 1 ? "inverse" : "cubic-spline";
  const Study study = parse_study(
      "[study]\nname = \"work\"\n[scene]\nuse = \"lee-du-2019\"\n[[scheme]]\nmodel = " + std::to_string(model) +
          "\ndivergence = \"local\"\nkernel = \"" + kernel +
          "\"\n[time]\nintegrator = \"forward-euler\"\nstep = \"h/4\"\n[[path]]\nname = \"p\"\ndelta = \"" + delta +
          "\"\nN = [" + std::to_string(N) + "]\nsource = \"local\"\n",
      "work.toml");
  return study.series.front().cases.front();
}

/// Where the particle started that is at x at time t: the flow is tan(x/2) = tan(x0/2) e^t.
double start_of(double x, double t) {
  const double turns = std::round(x / (2.0 * pi));
  const double rest = x - 2.0 * pi * turns;
  return 2.0 * std::atan2(std::sin(0.5 * rest) * std::exp(-t), std::cos(0.5 * rest)) + 2.0 * pi * turns;
}

/// Neighbors within delta, at least one: particles are h apart where they started, so none has to be looked for.
double neighbors(const Case& c, double x0, double t, double side) {
  const double x = 2.0 * std::atan2(std::sin(0.5 * x0) * std::exp(t), std::cos(0.5 * x0));
  const double turned = x + 2.0 * pi * std::round((x0 - x) / (2.0 * pi));
  const double reach = std::abs(start_of(turned + side * c.delta, t) - x0) / c.h;
  return std::max(1.0, std::floor(reach * (1.0 + 1e-10)));
}

/// Pairs of all stages, counted in closed form.
double pairs_in_closed_form(const Case& c) {
  double pairs = 0.0;
  for (std::int64_t n = 0; n < c.steps; ++n) {
    const double t = static_cast<double>(n) * c.dt;
    for (std::int64_t j = 0; j < c.N; ++j) {
      const double x0 = static_cast<double>(j) * c.h;
      const double x = 2.0 * std::atan2(std::sin(0.5 * x0) * std::exp(t), std::cos(0.5 * x0));
      const double c_hat = std::cos(2.0 * x) / 3.0 - std::sin(x);
      if (c.scheme.model == &model_two || c_hat > 0.0) pairs += neighbors(c, x0, t, -1.0);
      if (c.scheme.model == &model_two || c_hat <= 0.0) pairs += neighbors(c, x0, t, 1.0);
    }
  }
  return pairs;
}

/// Pairs of both sides without rounding to whole neighbors: the integral of the product of densities,
/// N/h 2 atan(cosh(t) tan(delta/2)) on each side.
double pairs_of_the_continuum(const Case& c) {
  double pairs = 0.0;
  for (std::int64_t n = 0; n < c.steps; ++n) {
    const double t = static_cast<double>(n) * c.dt;
    pairs += 2.0 * static_cast<double>(c.N) / c.h * 2.0 * std::atan(std::cosh(t) * std::tan(0.5 * c.delta));
  }
  return pairs;
}

CaseResult run(const Case& c) {
  const std::atomic<bool> stop{false};
  return run_case(c, stop);
}

}  // namespace

TEST_CASE("pairs are those of the closed form", "[work]") {
  for (const int model : {1, 2}) {
    for (const std::string delta : {"0.2", "4*h", "sqrt(h)", "h^2"}) {
      for (const int N : {80, 160}) {
        const Case c = paper_case(model, delta, N);
        const auto pairs = static_cast<double>(run(c).work.pairs);
        CAPTURE(model, delta, N);
        // Where a neighbor is at the horizon but for round-off, either count is right.
        CHECK(pairs == Approx(pairs_in_closed_form(c)).epsilon(1e-5));
        // A horizon wider by one spacing, or steps one more, would be noticed.
        Case wider = c, longer = c;
        wider.delta += c.h;
        ++longer.steps;
        CHECK(pairs != Approx(pairs_in_closed_form(longer)).epsilon(1e-5));
        if (delta != "h^2") CHECK(pairs != Approx(pairs_in_closed_form(wider)).epsilon(1e-5));
      }
    }
  }
}

TEST_CASE("pairs grow like N^2 delta/h", "[work]") {
  for (const int N : {160, 320}) {
    const Case c = paper_case(2, "0.3", N);
    const auto pairs = static_cast<double>(run(c).work.pairs);
    const double law = pairs_of_the_continuum(c);
    // Rounding down takes less than one neighbor from each side of each particle.
    const double rounding = 2.0 * static_cast<double>(c.N * c.steps);
    CHECK(pairs <= law);
    CHECK(pairs > law - rounding);
    // Half a neighbor is what it takes on average; one neighbor more or less on each side would be noticed.
    CHECK(std::abs(pairs - (law - 0.5 * rounding)) < 0.05 * rounding);
    CHECK_FALSE(std::abs(pairs + rounding - (law - 0.5 * rounding)) < 0.05 * rounding);
  }
  const auto coarse = static_cast<double>(run(paper_case(2, "0.3", 160)).work.pairs);
  const auto fine = static_cast<double>(run(paper_case(2, "0.3", 320)).work.pairs);
  // Steps, particles and neighbors double, but for half a neighbor per side.
  CHECK(fine / coarse == Approx(8.0).epsilon(0.08));
}

TEST_CASE("standing particles have one build of weights and the same pairs in every step", "[work]") {
  Case c = paper_case(1, "4*h", 80);
  const Study study = parse_study(
      "[study]\nname = \"s\"\n[scene]\nperiod = \"2*pi\"\nT = 1\nc = \"1 + cos(x)/2\"\nu = \"sin(x-t)\"\n[[scheme]]\n"
      "model = 1\ndivergence = \"local\"\nkernel = \"inverse\"\n[time]\nintegrator = \"ssprk2\"\nstep = \"h/4\"\n"
      "[[path]]\nname = \"p\"\ndelta = \"4*h\"\nN = [80]\nsource = \"local\"\n",
      "s.toml");
  c = study.series.front().cases.front();
  const CaseResult result = run(c);
  CHECK(result.work.weight_builds == 1);
  CHECK(result.work.pairs == 2 * 4 * 80 * c.steps);
}

}  // namespace acstudy
