#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "solver/line/particles.hpp"
#include "studies/kinds/study_file.hpp"
#include "studies/models/arrangement.hpp"
#include "studies/running/run_case.hpp"
#include "studies/running/watch.hpp"
#include "tests/catch.hpp"

namespace acstudy {
namespace {

/// The cases of a study with one path, one scheme and one way to step.
std::vector<Case> cases(const std::string& time, const std::string& delta = "h^2", const std::string& N = "40",
                        const std::string& more = "",
                        const std::string& scheme = "model = 1\nkernel = \"cubic-spline\"",
                        const std::string& scene = "use = \"lee-du-2019\"") {
  const Study study = parse_study(
      "[study]\nname = \"tiny\"\n[scene]\n" + scene + "\n[[scheme]]\ndivergence = \"local\"\n" + scheme + "\n[time]\n" +
          time + "\n[[path]]\nname = \"p\"\ndelta = \"" + delta + "\"\nN = [" + N + "]\nsource = \"local\"\n" + more,
      "tiny.toml");
  return study.series.front().cases;
}

CaseResult run(const Case& c) {
  const std::atomic<bool> stop{false};
  return run_case(c, stop);
}

const std::string by_forward_euler = "integrator = \"forward-euler\"\nstep = ",
                  by_backward_euler = "integrator = \"backward-euler\"\nstep = ",
                  sdirk2 = "integrator = \"sdirk2\"\nstep = ";
const std::string near_coincident = "start = { name = \"jittered\", smallest_gap = 1e-4, seed = 3 }\n";

}  // namespace

TEST_CASE("starts have the gaps that they promise", "[start]") {
  for (const double smallest : {0.5, 0.1, 1e-2, 1e-4, 1e-6}) {
    for (const std::size_t N : {3U, 10U, 640U}) {
      const double period = 6.5, h = period / static_cast<double>(N);
      CAPTURE(smallest, N);
      const auto jittered = start_positions({Start::Kind::jittered, smallest, 2}, N, period);
      CHECK(std::is_sorted(jittered.begin(), jittered.end()));
      const Gaps gap = gaps(jittered, period);
      // The rounding of positions is all that the gap may differ by.
      CHECK(std::abs(gap.smallest - smallest * h) < 4e-15);
      CHECK(gap.largest < (3.0 - 2.0 * smallest) * h);
      CHECK(start_positions({Start::Kind::jittered, smallest, 2}, N, period) == jittered);
      CHECK(start_positions({Start::Kind::jittered, smallest, 3}, N, period) != jittered);
    }
    const double h = 6.5 / 640.0;
    for (const std::size_t N : {3U, 4U, 5U, 6U, 641U}) {
      const Gaps few = gaps(start_positions({Start::Kind::clustered, smallest}, N, 6.5), 6.5);
      CHECK(std::abs(few.smallest - smallest * 6.5 / static_cast<double>(N)) < 4e-15);
    }
    const Gaps clustered = gaps(start_positions({Start::Kind::clustered, smallest}, 640, 6.5), 6.5);
    CHECK(std::abs(clustered.smallest - smallest * h) < 4e-15);
    CHECK(clustered.largest == Approx((2.0 - smallest) * h).epsilon(1e-3));
  }
  CHECK(start_positions({}, 10, 2.0) == uniform_positions(10, 2.0));
}

TEST_CASE("steps that follow the lemma stay at the safety factor, and reach T", "[steps]") {
  for (const std::string scheme : {"model = 1\nkernel = \"inverse\"", "model = 2\nkernel = \"cubic-spline\""}) {
    const Case c = cases(by_forward_euler + "\"cfl\"\nsafety = 0.7", "4*h", "40", "", scheme).front();
    const CaseResult result = run(c);
    REQUIRE(result.blow_up.empty());
    CHECK(result.against_bound.largest <= 0.7 + 1e-12);
    CHECK(result.against_bound.largest > 0.68);
    CHECK(result.against_bound.first_step == 0);
    // The gaps close by the factor e within T = 1, and the steps with them.
    CHECK(result.dt / result.dt_smallest == Approx(std::exp(1.0)).epsilon(0.15));
    CHECK(result.steps > c.steps);
    const Case equal = cases(by_forward_euler + "\"h/16\"", "4*h", "40", "", scheme).front();
    CHECK(result.error_linf == Approx(run(equal).error_linf).epsilon(0.3));
  }
}

TEST_CASE("steps keep the bound at later stages too, where gaps close", "[steps]") {
  for (const std::string integrator : {"ssprk2", "ssprk3"}) {
    for (const std::string bound : {"", "\nbound = \"rows\""}) {
      const Case c = cases("integrator = \"" + integrator + "\"\nstep = \"cfl\"" + bound, "0.5*h", "10", "",
                           "model = 1\nkernel = \"inverse\"", "use = \"lee-du-2019\"\nT = 3")
                         .front();
      const CaseResult result = run(c);
      CAPTURE(integrator, bound, result.against_bound.largest);
      CHECK(result.blow_up.empty());
      if (bound.empty()) {
        CHECK(result.against_bound.largest <= 0.9 + 1e-12);
        CHECK(result.against_bound.largest > 0.7);
      }
    }
  }
}

TEST_CASE("a run that fails keeps what was said of its steps", "[steps]") {
  // Gaps close until positions cannot tell particles apart.
  const Case c = cases(by_forward_euler + "\"h\"", "0.5*h", "20", "", "model = 1\nkernel = \"inverse\"",
                       "period = \"2*pi\"\nT = 40\nc = \"cos(2*x)/3\"\nb = \"sin(x)\"\nu = \"0*x\"")
                     .front();
  const CaseResult result = run(c);
  CAPTURE(result.failure, result.blow_up);
  CHECK(result.failure.find("particles have crossed") != std::string::npos);
  CHECK(result.failure.find("in step " + std::to_string(result.last.step + 1)) != std::string::npos);
  CHECK(result.against_bound.first_step > 0);
}

TEST_CASE("a bound by the rows allows larger steps where the horizon is above the gaps, and is stable", "[steps]") {
  const auto lemma = run(cases(by_forward_euler + "\"cfl\"", "4*h", "40", near_coincident).front());
  const auto rows = run(cases(by_forward_euler + "\"cfl\"\nbound = \"rows\"", "4*h", "40", near_coincident).front());
  REQUIRE(rows.blow_up.empty());
  CHECK(rows.steps * 1000 < lemma.steps);
  CHECK(rows.error_linf == Approx(lemma.error_linf).epsilon(0.3));
  // Beyond the lemma all the time, which is said, and judged by what happens.
  CHECK(rows.against_bound.first_step == 1);
  CHECK(rows.against_bound.largest > 1000.0);
}

TEST_CASE("steps beyond the bound are reported: first step, time, place and factor", "[steps]") {
  // Gaps close like e^-t at x = pi; dt = h/4 is within h_min / (4/3) until e^-t = 1/3.
  const CaseResult result = run(cases(by_forward_euler + "\"h/4\"", "4*h", "200", "", "model = 1\nkernel = \"inverse\"",
                                      "use = \"lee-du-2019\"\nT = 2")
                                    .front());
  REQUIRE(result.blow_up.empty());
  CHECK(result.against_bound.first_time == Approx(std::log(3.0)).epsilon(0.01));
  CHECK(static_cast<double>(result.against_bound.first_step - 1) * result.dt ==
        Approx(result.against_bound.first_time).epsilon(1e-12));
  CHECK(result.against_bound.first_place == Approx(3.14159).margin(0.05));
  CHECK(result.against_bound.largest == Approx(std::exp(2.0) / 3.0).epsilon(0.02));
  // Within the bound nothing is reported; implicit steps have none.
  CHECK(run(cases(by_forward_euler + "\"h/4\"", "4*h", "200").front()).against_bound.first_step == 0);
  CHECK(run(cases(by_backward_euler + "\"h\"", "4*h").front()).against_bound.largest == 0.0);
}

TEST_CASE("implicit integrators have their order in time", "[implicit][steps]") {
  const std::string standing = "use = \"standing-variable-velocity\"", moving = "use = \"lee-du-2019\"";
  // Where neighbors enter horizons, or particles change sides, rates are not smooth in time: on moving particles only
  // Model II with its nearest neighbors has rates that are.
  for (const auto& [scheme, scene, delta] : {std::tuple{"model = 1\nkernel = \"cubic-spline\"", standing, "3*h"},
                                             std::tuple{"model = 2\nkernel = \"cubic-spline\"", standing, "3*h"},
                                             std::tuple{"model = 2\nkernel = \"cubic-spline\"", moving, "1e-3*h"}}) {
    for (const auto& [integrator, order] : {std::pair{by_backward_euler, 1.0}, std::pair{sdirk2, 2.0}}) {
      std::vector<std::vector<double>> u;
      for (const char* const step : {"1/40", "1/80", "1/160", "1/320"}) {
        const CaseResult result = run(cases(integrator + "\"" + step + "\"", delta, "60", "", scheme, scene).front());
        REQUIRE(result.blow_up.empty());
        u.push_back(result.u);
      }
      std::vector<double> difference;
      for (std::size_t i = 1; i < u.size(); ++i) {
        double largest = 0.0;
        for (std::size_t j = 0; j < u[i].size(); ++j) largest = std::max(largest, std::abs(u[i][j] - u[i - 1][j]));
        difference.push_back(largest);
      }
      CAPTURE(scheme, scene, order, difference);
      CHECK(std::log2(difference[1] / difference[2]) == Approx(order).margin(0.12));
    }
  }
}

TEST_CASE("implicit steps go on where explicit ones of the same length blow up", "[implicit][steps]") {
  for (const std::string scheme : {"model = 1\nkernel = \"inverse\"", "model = 2\nkernel = \"cubic-spline\""}) {
    // The horizon is below the smallest gap, so that the scheme sees it.
    const std::string below = "1e-5*h";
    const CaseResult within = run(cases(by_backward_euler + "\"h/4\"", below, "40", near_coincident, scheme).front());
    const CaseResult second = run(cases(sdirk2 + "\"h/4\"", below, "40", near_coincident, scheme).front());
    const CaseResult beyond = run(cases(by_forward_euler + "\"h/4\"", below, "40", near_coincident, scheme).front());
    CHECK(within.error_linf < 0.5);
    CHECK(second.error_linf < 0.5);
    CHECK(!beyond.blow_up.empty());
  }
}

TEST_CASE("a run that blows up stops early, says where, and keeps its last finite state", "[unstable]") {
  const Case c = cases(by_forward_euler + "\"3*h\"", "1e-3*h", "640").front();
  const CaseResult result = run(c);
  CAPTURE(result.blow_up);
  REQUIRE(!result.blow_up.empty());
  CHECK(result.failure.empty());
  CHECK(std::isnan(result.error_linf));
  CHECK(result.last.step > 0);
  CHECK(result.last.step < c.steps);
  CHECK(result.last.time == Approx(static_cast<double>(result.last.step) * c.dt));
  REQUIRE(result.last.particle >= 0);
  const auto j = static_cast<std::size_t>(result.last.particle);
  CHECK(result.last.place == result.x.coordinates[j]);
  CHECK(std::abs(result.u[j]) > GrowthWatch::most);
  CHECK(result.last.error_linf == Approx(std::abs(result.u[j])).epsilon(1e-5));
  CHECK(std::isfinite(result.last.error_l1));
  CHECK(std::all_of(result.u.begin(), result.u.end(), [](double value) { return std::isfinite(value); }));
  CHECK(result.blow_up.find("step " + std::to_string(result.last.step)) != std::string::npos);
  CHECK(result.blow_up.find("particle " + std::to_string(j)) != std::string::npos);
}

TEST_CASE("the watch over growth gives up for good reasons only", "[unstable]") {
  std::vector<double> u = {1.0, -2.0, 0.5};
  const auto exact = [](double size) { return [size] { return size; }; };
  const auto never = []() -> double { throw std::logic_error("nothing was suspicious"); };
  SECTION("a solution that grows with the exact one is let go on") {
    GrowthWatch watch(u);
    u[1] = -1e9;
    CHECK(watch.makes_sense(1, 0.1, u, exact(2e9)));
    u[1] = -1e12;
    CHECK(watch.makes_sense(2, 0.2, u, never));
    u[1] = -1e16;
    CHECK(!watch.makes_sense(3, 0.3, u, exact(2e9)));
    CHECK(watch.last().step == 3);
    CHECK(watch.last().particle == 1);
    CHECK(u[1] == -1e16);
  }
  SECTION("what is not finite is given up, and the state before it comes back") {
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
      u = {1.0, -2.0, 0.5};
      GrowthWatch watch(u);
      u[2] = 0.75;
      CHECK(watch.makes_sense(1, 0.1, u, never));
      u = {7.0, bad, 8.0};
      CHECK(!watch.makes_sense(2, 0.2, u, never));
      CHECK(u == std::vector<double>{1.0, -2.0, 0.75});
      CHECK(watch.last().step == 1);
      CHECK(watch.last().time == 0.1);
      CHECK(watch.last().particle == 1);
      CHECK(watch.blow_up().find("after step 2") != std::string::npos);
    }
  }
  SECTION("zero initial values are no reason") {
    std::fill(u.begin(), u.end(), 0.0);
    GrowthWatch watch(u);
    u[0] = 1e-9;
    CHECK(watch.makes_sense(1, 0.1, u, exact(1e-9)));
  }
}

}  // namespace acstudy
