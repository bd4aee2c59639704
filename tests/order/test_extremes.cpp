#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "studies/claims/extreme_rows.hpp"
#include "studies/storing/store.hpp"
#include "tests/catch.hpp"
#include "tests/irregular_particles.hpp"

namespace acstudy {
namespace {

SchemeChoice scheme(int model, bool nonlocal, KernelChoice kernel) {
  return {.model = find_model(model),
          .nonlocal_divergence = nonlocal,
          .kernel = std::move(kernel),
          .mu = {},
          .control = {}};
}

/// Both models with a smooth and a singular kernel and either divergence, on fewer particles and steps than the study.
const Extremes coarse{{scheme(1, false, {"power", 1.5}), scheme(1, true, {"cubic-spline"}),
                       scheme(2, true, {"cubic-spline"}), scheme(2, false, {"power", 0.5})},
                      2000,
                      2000};

/// Takes every measurement of the rows that `add` adds: each is as expected, and each expectation has findings that
/// hold and a control that does not.
void check_rows(void (*add)(ExtremeRows&, const Extremes&), const std::string& statement) {
  ExtremeRows rows;
  add(rows, coarse);
  struct Count {
    int right = 0, controls = 0;
  };
  std::map<std::string, Count> claims;
  for (const Measurement& measurement : rows.take()) {
    if (measurement.check.label().rfind(statement, 0) != 0) continue;
    const Finding finding = measurement.take();
    INFO(finding.claim << "\n" << finding.label() << "\n" << finding.judgement.reason);
    CHECK(finding.label() == measurement.check.label());
    CHECK(finding.as_expected());
    CHECK_FALSE(finding.points.empty());
    ++(finding.expected == finding.promised ? claims[finding.claim].right : claims[finding.claim].controls);
  }
  CHECK_FALSE(claims.empty());
  for (const auto& [claim, count] : claims) {
    INFO(claim);
    CHECK(count.right > 0);
    CHECK(count.controls > 0);
  }
}

TEST_CASE("extremes: from three particles to many", "[extremes]") { check_rows(add_rows_of_resolution, "N = "); }
TEST_CASE("extremes: horizons from next to nothing to half the period", "[extremes]") {
  check_rows(add_rows_of_resolution, "delta/h");
}
TEST_CASE("extremes: kernels as singular as they can be", "[extremes]") { check_rows(add_rows_of_resolution, "alpha"); }
TEST_CASE("extremes: no velocity", "[extremes]") { check_rows(add_rows_of_velocity, "c = 0"); }
TEST_CASE("extremes: a constant velocity", "[extremes]") { check_rows(add_rows_of_velocity, "c constant"); }
TEST_CASE("extremes: particles that move with the flow", "[extremes]") { check_rows(add_rows_of_velocity, "b = c"); }
TEST_CASE("extremes: a particle at a zero of the relative velocity", "[extremes]") {
  check_rows(add_rows_of_velocity, "a particle at a zero");
}
TEST_CASE("extremes: coincident particles", "[extremes]") { check_rows(add_rows_of_positions, "coincident"); }
TEST_CASE("extremes: amplitudes", "[extremes]") { check_rows(add_rows_of_amplitude, "amplitude"); }
TEST_CASE("extremes: no time", "[extremes]") { check_rows(add_rows_of_time, "T = 0"); }
TEST_CASE("extremes: one step", "[extremes]") { check_rows(add_rows_of_time, "one step"); }
TEST_CASE("extremes: at the CFL number and beyond", "[extremes]") { check_rows(add_rows_of_time, "CFL"); }
TEST_CASE("extremes: many steps", "[extremes]") { check_rows(add_rows_of_time, "2000 steps"); }
TEST_CASE("extremes: square wave and hat", "[extremes]") { check_rows(add_rows_of_shapes, "square wave"); }
TEST_CASE("extremes: mass drift", "[extremes]") { check_rows(add_rows_of_mass, "mass drift"); }

TEST_CASE("the table of extremes has every row, each once", "[extremes]") {
  std::set<std::string> names, statements;
  for (const Measurement& measurement : extreme_rows(coarse)) {
    CHECK(names.insert(measurement.check.label()).second);
    statements.insert(measurement.check.statement);
  }
  CHECK(statements == std::set<std::string>{"2000 steps", "CFL 1, 1.01, 2", "N = 3 to 2000", "T = 0",
                                            "a particle at a zero of c_hat", "alpha -> 2", "amplitude 1e300 and 1e-300",
                                            "b = c", "c = 0", "c constant", "coincident particles",
                                            "delta/h = 1e-12 to period/2", "mass drift", "one step",
                                            "square wave and hat"});
}

TEST_CASE("any schemes make a table of extremes", "[extremes]") {
  const std::vector<SchemeChoice> schemes = {scheme(1, true, {"power", 1.9}), scheme(1, true, {"power", 0.5}),
                                             scheme(2, false, {"power", 0.9}), scheme(2, false, {"power", -1.0})};
  for (std::size_t count = 1; count <= schemes.size(); ++count) {
    CHECK_FALSE(extreme_rows({{schemes.begin(), schemes.begin() + static_cast<std::ptrdiff_t>(count)}}).empty());
  }
  CHECK_FALSE(extreme_rows({{schemes.back()}}).empty());
}

TEST_CASE("printed sums are the rates of the schemes", "[extremes]") {
  for (const auto& choice : coarse.schemes) {
    for (const std::string name : {"lee-du-2019", "standing-variable-velocity"}) {
      const Subject subject = subject_on(choice, scene_named(name));
      for (const double delta : {0.01, 0.7, 2.9}) {
        const std::vector<double> x = test::irregular_positions(19, subject.scene->period(), 5), u = uneven_values(19);
        PlacedScheme placed(subject.scheme, *subject.scene, subject.mu, x, delta);
        const std::vector<double> rate = placed.rate(u);
        for (std::size_t j = 0; j < x.size(); ++j) {
          const PrintedRate printed = subject.printed_rate(x, u, delta, j);
          CHECK(std::abs(rate[j] - printed.value) <= 1e-14 * printed.size);
          CHECK(std::abs(printed.value) <= printed.size);
        }
      }
    }
  }
}

TEST_CASE("a run without source is that of a case whose source is zero", "[extremes]") {
  // u = 1 solves u_t + (c u)_x = 0 for c = 1, and stays; u = sin(2 pi (x - t)) needs no source either.
  for (const auto& b : {std::optional<std::string>{}, std::optional<std::string>{"1/3"}}) {
    const Subject subject = subject_on(coarse.schemes[0], scene_with("1", b));
    const std::vector<double> x = uniform_positions(40, 1.0);
    std::vector<double> u(x.size());
    subject.scene->u(x, 0.0, u);
    const State end = run_freely(subject, {x, u}, 0.06, 1.0, 100);
    const CaseResult result = run(case_of(subject, 40, 0.06, 100));
    for (std::size_t j = 0; j < x.size(); ++j) {
      CHECK(end.u[j] == Approx(result.u[j]).margin(1e-13));
      CHECK(end.x[j] == result.x.coordinates[j]);
    }
  }
}

TEST_CASE("what cannot be measured is a finding without a verdict, and a control is not listed twice", "[extremes]") {
  const Check row{.statement = "row", .claim = "a claim", .subject = "nothing", .coordinates = {{"where", "here"}}};
  ExtremeRows rows;
  rows.add(row, [](Finding&) { throw std::domain_error("no particles"); });
  Check control = row;
  control.coordinates = {{"where", "there"}};
  rows.add_control(control, "it must",
                   [](Finding& finding) { finding.points.push_back({.value = 2.0, .upper = 1.0}); });
  rows.add_control(control, "it must", [](Finding&) {});
  const auto taken = rows.take();
  REQUIRE(taken.size() == 2);
  const Finding failed = taken[0].take(), caught = taken[1].take();
  CHECK(failed.statement == "row");
  CHECK(failed.judgement.verdict == Verdict::inconclusive);
  CHECK_FALSE(failed.as_expected());
  CHECK(caught.judgement.verdict == Verdict::violated);
  CHECK(caught.as_expected());
  CHECK(caught.remark == "negative control: it must");
}

TEST_CASE("excursions and refusals say what they measure", "[extremes]") {
  CHECK(excursion(std::vector<double>{0.0, 1.0}, 0.0, 1.0) == 0.0);
  CHECK(excursion(std::vector<double>{-0.5, 1.25}, 0.0, 1.0) == 0.5);
  CHECK(excursion(std::vector<double>{0.5}, 0.0, 1.0) == -0.5);
  CHECK(std::isnan(excursion(std::vector<double>{0.5, NAN, 3.0}, 0.0, 1.0)));
  CHECK(refused<std::domain_error>([] { throw std::domain_error("too close"); }, "close") == 1.0);
  CHECK(refused<std::domain_error>([] { throw std::domain_error("too far"); }, "close") == 0.5);
  CHECK(refused<std::domain_error>([] {}, "close") == 0.0);
}

}  // namespace
}  // namespace acstudy
