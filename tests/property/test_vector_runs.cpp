#include <algorithm>
#include <atomic>
#include <memory>

#include "studies/running/run_case.hpp"
#include "studies/running/stopwatch.hpp"
#include "tests/catch.hpp"
#include "tests/general_tables.hpp"
#include "tests/irregular_particles.hpp"
#include "tests/named_scene.hpp"
#include "tests/random_cases.hpp"

using namespace acstudy;
using namespace acstudy::test;

namespace {

CaseResult result_of(Case c, bool readable, int threads = 1) {
  const std::atomic<bool> stop{false};
  c.readable = readable;
  return run_case(c, stop, 1, threads);
}

}  // namespace

TEST_CASE("A run in the vector form ends where the readable one does, whatever the integrator, scene, source and start",
          "[vector][runs]") {
  std::vector<Integrator> all(std::begin(integrators), std::end(integrators));
  all.insert(all.end(), std::begin(test::general_tables), std::end(test::general_tables));
  for (const char* const name : {"lee-du-2019", "standing-variable-velocity", "lagrangian"}) {
    const auto scene = named_scene(name);
    for (const Integrator& integrator : all) {
      for (const int model : {1, 2}) {
        for (const bool nonlocal : {false, true}) {
          for (const auto bound : {StepRule::Bound::none, StepRule::Bound::lemma, StepRule::Bound::rows}) {
            constexpr std::int64_t N = 50;
            const double h = scene->period() / N;
            Case c{.scene = scene,
                   .scheme = {find_model(model), nonlocal, {"cubic-spline"}, {}, {}},
                   .mu = model == 2 ? 1.6 : 0.0,
                   .nonlocal_source = nonlocal,
                   .source_rule = SourceRule::gauss,
                   .integrator = &integrator,
                   .N = N,
                   .h = h,
                   .delta = 3.3 * h,
                   .dt = scene->T() / 100,
                   .steps = 100};
            c.start = {.kind = Start::Kind::jittered, .smallest_gap = 0.3, .seed = 2};
            if (scene->max_relative_velocity() > 0.0) c.step = {.bound = bound, .safety = 0.5, .text = "cfl"};
            CAPTURE(c.key());
            REQUIRE(plan(c).form->together);
            const CaseResult vector = result_of(c, false), readable = result_of(c, true);
            CHECK(relative_gap(vector.u, readable.u) <= 1e-12);
            CHECK(relative_gap(vector.x.coordinates, readable.x.coordinates) <= 1e-14);
            CHECK(vector.steps == readable.steps);
            CHECK(vector.work.pairs == readable.work.pairs);
            CHECK(vector.against_bound.first_step == readable.against_bound.first_step);
            CHECK(result_of(c, false, 3).u == vector.u);
          }
        }
      }
    }
  }
}

TEST_CASE("Runs with kernels from tables end as in the readable form, however wide windows are", "[vector][runs]") {
  const auto scene = named_scene("lee-du-2019");
  constexpr std::int64_t N = 101;  // the last vector has lanes without a particle
  const double h = scene->period() / N;
  // Ghosts of positions come 32 at a time.
  for (int neighbors = 2; neighbors < 40; ++neighbors) {
    for (const int model : {1, 2}) {
      const Case c{.scene = scene,
                   .scheme = {find_model(model), false, {"wendland-c2"}, {}, {}},
                   .mu = model == 2 ? 1.6 : 0.0,
                   .nonlocal_source = false,
                   .source_rule = SourceRule::gauss,
                   .integrator = &integrators[0],
                   .N = N,
                   .h = h,
                   .delta = (neighbors + 0.1) * h,
                   .dt = 0.01 * h,
                   .steps = 2};
      CAPTURE(c.key());
      const CaseResult vector = result_of(c, false), readable = result_of(c, true);
      CHECK(relative_gap(vector.u, readable.u) <= 1e-12);
      CHECK(vector.work.pairs == readable.work.pairs);
    }
  }
}

TEST_CASE("Cases that share their particles end as each would alone", "[vector]") {
  const auto scene = named_scene("lee-du-2019");
  std::vector<Case> cases;
  for (const double delta : {0.02, 0.2}) {
    for (const int model : {1, 2}) {
      for (const bool nonlocal : {false, true}) {
        for (const bool source : {false, true}) {
          constexpr std::int64_t N = 120;
          cases.push_back({.scene = scene,
                           .scheme = {find_model(model), nonlocal, {"cubic-spline"}, {}, {}},
                           .mu = model == 2 ? 4.0 / 3.0 : 0.0,
                           .nonlocal_source = source,
                           .source_rule = SourceRule::gauss,
                           .integrator = &forward_euler,
                           .N = N,
                           .h = scene->period() / N,
                           .delta = delta,
                           .dt = 1.0 / 160.0,
                           .steps = 160});
        }
      }
    }
  }
  std::vector<const Case*> together;
  for (const Case& c : cases) together.push_back(&c);
  const std::vector<Plan> plans = plan(together);
  for (const Plan& one : plans) CHECK(one.particles == plans.front().particles);
  const std::atomic<bool> stop{false};
  double seconds = 0.0, passed = 0.0;
  std::vector<CaseResult> results;
  timed(passed, [&] { results = run_cases(plans, stop); });
  for (std::size_t i = 0; i < cases.size(); ++i) {
    CAPTURE(cases[i].key());
    CHECK(results[i].u == result_of(cases[i], false).u);
    seconds += results[i].seconds;
  }
  // shares of the time that passed
  CHECK(seconds <= passed);
  CHECK(seconds > 0.5 * passed);
}

TEST_CASE("Cases that would take too long together are put off, and end as each would alone", "[vector]") {
  const auto scene = named_scene("lee-du-2019");
  std::vector<Case> cases;
  for (int i = 0; i < 8; ++i)
    cases.push_back(case_on(scene, 2, i % 2 == 1, {"cubic-spline"}, 600, 1.0 + 0.1 * (i / 2)));
  std::vector<const Case*> open;
  for (const Case& c : cases) open.push_back(&c);
  const std::atomic<bool> stop{false};
  std::size_t rounds = 0;
  for (; !open.empty(); ++rounds) {
    const std::vector<CaseResult> results = run_cases(plan(open), stop, 2, 1, 1e-9);
    std::vector<const Case*> put_off;
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (results[i].completed) {
        CHECK(results[i].u == result_of(*open[i], false).u);
        CHECK(results[i].repeats == 2);
      } else {
        put_off.push_back(open[i]);
      }
    }
    REQUIRE(put_off.size() < open.size());
    open = put_off;
  }
  CHECK(rounds > 1);
}

TEST_CASE("A case that fails takes none of those along that share its particles", "[vector]") {
  // Within this horizon the solution waves more often than any Gauss rule of the source can follow.
  const auto scene = std::make_shared<const Scene>(SceneText{
      .name = {}, .period = "2*pi", .T = "1/100", .c = "cos(2*x)/3", .b = "sin(x)", .u = "cos(60*x - t)", .flow = {}});
  const Case sound = case_on(scene, 1, true, {"inverse"}, 40, 0.3);
  Case failing = case_on(scene, 1, true, {"inverse"}, 40, 3.0);
  failing.nonlocal_source = true;
  const Case* const together[] = {&failing, &sound};
  const std::vector<Plan> plans = plan(together);
  REQUIRE(plans[0].particles == plans[1].particles);
  const std::atomic<bool> stop{false};
  const std::vector<CaseResult> results = run_cases(plans, stop);
  CHECK(!results[0].failure.empty());
  CHECK(results[1].failure.empty());
  CHECK(results[1].u == result_of(sound, false).u);
}

TEST_CASE("Velocities that are no short trigonometric series run in the vector form as far as they are smooth",
          "[vector]") {
  for (const bool smooth : {true, false}) {
    const auto scene = std::make_shared<const Scene>(SceneText{.name = {},
                                                               .period = "2*pi",
                                                               .T = "1/4",
                                                               .c = smooth ? "exp(sin(x))/3" : "abs(sin(x))/3",
                                                               .b = "sin(x)/(2 + cos(x))",
                                                               .u = "cos(x - t)",
                                                               .flow = {}});
    for (const int model : {1, 2}) {
      for (const bool nonlocal : {true, false}) {
        const Case c{.scene = scene,
                     .scheme = {find_model(model), nonlocal, {"cubic-spline"}, {}, {}},
                     .mu = model == 2 ? 2.0 : 0.0,
                     .nonlocal_source = smooth,
                     .source_rule = SourceRule::gauss,
                     .integrator = &forward_euler,
                     .N = 160,
                     .h = scene->period() / 160,
                     .delta = 0.3,
                     .dt = 1.0 / 240.0,
                     .steps = 60};
        CAPTURE(c.key());
        CHECK(plan(c).form->together == (smooth || model == 1));
        CHECK(relative_gap(result_of(c, false).u, result_of(c, true).u) <= 1e-12);
        CHECK(result_of(c, false, 2).u == result_of(c, false).u);
      }
    }
  }
}
