#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "studies/kinds/study_file.hpp"
#include "studies/running/run_case.hpp"
#include "tests/catch.hpp"

using namespace acstudy;
using Catch::Matchers::WithinRel;

namespace {

Case case_of(const std::string& scheme, const std::string& delta, int N, const std::string& scene = "lee-du-2019",
             const std::string& integrator = "ssprk3") {
  const Study study = parse_study("[study]\nname = \"second-order\"\n[scene]\nuse = \"" + scene + "\"\n[[scheme]]\n" +
                                      scheme + "\n[time]\nintegrator = \"" + integrator +
                                      "\"\nstep = \"h/8\"\n[[path]]\nname = \"p\"\n"
                                      "delta = \"" +
                                      delta + "\"\nN = [" + std::to_string(N) + "]\nsource = \"local\"\n",
                                  "second-order.toml");
  return study.series.at(0).cases.at(0);
}

CaseResult run(const Case& c) {
  const std::atomic<bool> stop{false};
  return run_case(c, stop);
}

}  // namespace

TEST_CASE("schemes of second order have the errors of an independent implementation", "[second-order]") {
  const std::string slopes = "model = \"slopes\"\ndivergence = \"local\"\nkernel = \"inverse\"";
  const std::string symmetric = "model = \"symmetric\"\ndivergence = \"local\"\nkernel = \"cubic-spline\"";
  struct Printed {
    std::string scheme, delta;
    int N;
    double error, half_a_unit;
  };
  const std::vector<Printed> all = {
      {slopes, "4*h", 80, 3.02e-2, 5e-5},    {slopes, "4*h", 160, 7.10e-3, 5e-6},
      {slopes, "h^2", 80, 1.91e-2, 5e-5},    {slopes, "h^2", 160, 3.81e-3, 5e-6},
      {symmetric, "4*h", 80, 1.98e-2, 5e-5}, {symmetric, "4*h", 160, 5.31e-3, 5e-6},
      {symmetric, "h^2", 80, 1.02e-2, 5e-5}, {symmetric, "h^2", 160, 2.77e-3, 5e-6},
  };
  for (const Printed& one : all) {
    INFO(one.scheme << ", delta = " << one.delta << ", N = " << one.N);
    const CaseResult result = run(case_of(one.scheme, one.delta, one.N));
    CHECK(result.completed);
    CHECK(result.failure == "");
    CHECK(std::abs(result.error_linf - one.error) <= one.half_a_unit);
  }
}

TEST_CASE("errors of second order fall by about four with each doubling, those with a limiter by less",
          "[second-order]") {
  const auto ratio = [](const std::string& scheme, const std::string& delta) {
    return run(case_of(scheme, delta, 160)).error_linf / run(case_of(scheme, delta, 320)).error_linf;
  };
  for (const std::string delta : {"4*h", "h^2"}) {
    INFO("delta = " << delta);
    CHECK(ratio("model = \"slopes\"\ndivergence = \"local\"\nkernel = \"cubic-spline\"", delta) > 3.3);
    CHECK(ratio("model = \"symmetric\"\ndivergence = \"local\"\nkernel = \"cubic-spline\"", delta) > 3.3);
    CHECK(ratio("model = \"symmetric\"\ndivergence = \"nonlocal\"\nkernel = \"cubic-spline\"", delta) > 3.3);
    CHECK(ratio("model = \"slopes\"\nlimiter = \"clip\"\ndivergence = \"local\"\nkernel = \"inverse\"", delta) < 3.3);
  }
}

TEST_CASE("schemes of second order run on standing particles and with implicit steps as in the readable form",
          "[second-order]") {
  for (const std::string model : {"slopes", "symmetric"}) {
    for (const std::string scene : {"standing-variable-velocity", "lee-du-2019"}) {
      for (const std::string integrator : {"ssprk3", "sdirk2"}) {
        for (const std::string divergence : {"local", "nonlocal"}) {
          INFO(model << ", " << scene << ", " << integrator << ", " << divergence);
          Case c = case_of("model = \"" + model + "\"\ndivergence = \"" + divergence + "\"\nkernel = \"cubic-spline\"",
                           "2.5*h", 60, scene, integrator);
          const CaseResult any = run(c);
          CHECK(any.failure == "");
          CHECK(any.error_linf < 0.1);
          c.readable = true;
          CHECK_THAT(run(c).error_linf, WithinRel(any.error_linf, 1e-9));
        }
      }
    }
  }
}
