#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "solver/line/far/far_sweeps.hpp"
#include "studies/models/scheme.hpp"
#include "studies/running/ensemble/sweep_group.hpp"
#include "tests/catch.hpp"
#include "tests/irregular_particles.hpp"
#include "tests/random_cases.hpp"

using namespace acstudy;
using namespace acstudy::test;

namespace {

/// Of rates and rows alike.
Needs needs_of(const Case& c) {
  return {.c_hat = true,
          .c_and_b = true,
          .b_prime = true,
          .midpoints = c.scheme.model == &model_two,
          .phases = true,
          .rows = true,
          .delta = c.delta};
}

struct Swept {
  std::vector<double> rate;
  std::int64_t pairs;
};

Swept swept_rates(const Case& c, const std::vector<double>& x, const std::vector<double>& u, bool with_twin,
                  int threads = 1) {
  Team team(threads);
  const VelocitySeries velocity(*c.scene);
  SharedParticles particles(*c.scene, velocity, x, needs_of(c), team);
  particles.move(0.0);
  SweepGroup group(c, particles, plan(c).form->far);
  const auto values = [&] {
    SweptValues v{PeriodicArray(x.size()), PeriodicArray(x.size()), ZeroedVector(x.size() + 16)};
    std::copy(u.begin(), u.end(), v.u.values().begin());
    return v;
  };
  SweptValues its_values = values(), of_twin = values();
  group.add(c, its_values);
  Case twin = c;
  twin.scheme.nonlocal_divergence = !twin.scheme.nonlocal_divergence;
  if (with_twin) group.add(twin, of_twin);
  particles.move(0.0, [&](const Piece& piece, Laps& laps) { group.prepare(piece, laps); });
  group.rates(team, [](const Piece&) {});
  return {{its_values.rate.begin(), its_values.rate.begin() + std::ssize(x)}, group.work().pairs};
}

Swept readable_rates(const Case& c, const std::vector<double>& x, const std::vector<double>& u) {
  const auto scheme = make_scheme(c.scheme, *c.scene, c.mu);
  const Particles particles = placed(x, c.scene->period(), c.delta);
  scheme->place(particles);
  Swept swept{rates(*scheme, u), 0};
  swept.pairs = scheme->work().pairs;
  return swept;
}

/// U with U - scale (R U) = u, by the vector form.
std::vector<double> swept_solution(const Case& c, const std::vector<double>& x, const std::vector<double>& u,
                                   double scale, bool with_twin, int threads = 1) {
  Team team(threads);
  const VelocitySeries velocity(*c.scene);
  SharedParticles particles(*c.scene, velocity, x, needs_of(c), team);
  particles.move(0.0);
  SweepGroup group(c, particles, false);
  SweptValues values{PeriodicArray(x.size()), PeriodicArray(), {}},
      of_twin{PeriodicArray(x.size()), PeriodicArray(), {}};
  std::copy(u.begin(), u.end(), values.u.values().begin());
  group.add(c, values);
  Case twin = c;
  twin.scheme.nonlocal_divergence = !twin.scheme.nonlocal_divergence;
  if (with_twin) group.add(twin, of_twin);
  group.solve(team, scale);
  REQUIRE(values.failure.empty());
  return {values.u.values().begin(), values.u.values().end()};
}

/// The same by the readable form and a sparse solver.
std::vector<double> readable_solution(const Case& c, const std::vector<double>& x, std::vector<double> u,
                                      double scale) {
  const auto scheme = make_scheme(c.scheme, *c.scene, c.mu);
  scheme->place(placed(x, c.scene->period(), c.delta));
  RateMatrix R;
  scheme->rows()->matrix(R);
  ImplicitSolver solver(ImplicitSolver::Method::sparse);
  solver.factorize(R, scale);
  solver.solve(u);
  return u;
}

const KernelChoice all_kernels[] = {{"inverse"},
                                    {"cubic-spline"},
                                    {"power", 0.5},
                                    {"power", -1.0},
                                    {"power", 1.5},
                                    {"quintic-spline"},
                                    KernelChoice::written({.text = "(1-s)^3*(1+3*s)", .density = true}),
                                    KernelChoice::written({.text = "1 + s", .exponent = 1.0})};

template <class Check>
void for_each_case(Check check) {
  unsigned seed = 0;
  for (const std::size_t N : {3, 7, 40, 165}) {
    const auto scene = random_scene(++seed);
    const double period = scene->period(), h = period / static_cast<double>(N);
    for (const int model : {1, 2}) {
      for (const bool nonlocal : {false, true}) {
        for (const KernelChoice& kernel : all_kernels) {
          if (model == 2 && !integrable(kernel)) continue;
          for (const double delta : {1e-3 * h, 1.3 * h, 4.7 * h, 0.31 * period, 0.49 * period}) {
            if (delta >= 0.5 * period) continue;
            const Case c = case_on(scene, model, nonlocal, kernel, N, delta);
            seed += 2;
            check(c, irregular_positions(N, period, seed), irregular_values(N, seed + 1));
          }
        }
      }
    }
  }
}

}  // namespace

TEST_CASE("The vector form has the readable form's rates and pairs, for random scenes, particles and kernels",
          "[vector]") {
  for_each_case([](const Case& c, const std::vector<double>& x, const std::vector<double>& u) {
    CAPTURE(c.key());
    const Swept expected = readable_rates(c, x, u);
    for (const bool with_twin : {false, true}) {
      const Swept swept = swept_rates(c, x, u, with_twin);
      CHECK(relative_gap(swept.rate, expected.rate) <= 1e-12);
      CHECK(swept.pairs == expected.pairs);
    }
  });
}

TEST_CASE("An implicit step in the vector form is that of the readable form, for random scenes, particles and kernels",
          "[vector][implicit]") {
  const Integrator* const implicit =
      std::find_if(std::begin(integrators), std::end(integrators), std::mem_fn(&Integrator::implicit));
  for_each_case([&](Case c, const std::vector<double>& x, const std::vector<double>& u) {
    c.integrator = implicit;
    // Within and beyond steps whose matrix is dominant.
    for (const double scale : {0.01, 0.5}) {
      CAPTURE(c.key(), scale);
      const std::vector<double> expected = readable_solution(c, x, u, scale);
      for (const bool with_twin : {false, true}) {
        CHECK(relative_gap(swept_solution(c, x, u, scale, with_twin), expected) <= 1e-12);
      }
    }
  });
}

TEST_CASE("A neighbor at the horizon counts in the vector form as it does in the readable one", "[vector]") {
  // On the uniform start with delta = 4h every particle ties.
  const auto scene = random_scene(77);
  constexpr std::size_t N = 64;
  const double h = scene->period() / N;
  for (const int model : {1, 2}) {
    Case c = case_on(scene, model, true, {"cubic-spline"}, N, 4.0 * h);
    const auto x = uniform_positions(N, scene->period());
    const auto u = irregular_values(N, 5);
    const Swept expected = readable_rates(c, x, u), swept = swept_rates(c, x, u, false);
    CHECK(swept.pairs == expected.pairs);
    CHECK(expected.pairs == static_cast<std::int64_t>(4 * N * (model == 1 ? 1 : 2)));
    CHECK(relative_gap(swept.rate, expected.rate) <= 1e-12);
    // the comparison sees a horizon that is short of the tie
    c.delta *= 1.0 - 1e-9;
    CHECK(relative_gap(swept_rates(c, x, u, false).rate, expected.rate) > 1e-3);
  }
}

namespace {

/// Rates and pairs of both forms for a horizon, Model I and II, each divergence alone and both together.
void check_forms_agree(const std::shared_ptr<const Scene>& scene, const std::vector<double>& x, double delta) {
  const auto u = irregular_values(x.size(), 8);
  for (const int model : {1, 2}) {
    for (const char* const kernel : {"inverse", "cubic-spline"}) {
      if (model == 2 && !integrable({kernel})) continue;
      for (const bool nonlocal : {false, true}) {
        const Case c = case_on(scene, model, nonlocal, {kernel}, x.size(), delta);
        CAPTURE(c.key());
        const Swept expected = readable_rates(c, x, u);
        for (const bool with_twin : {false, true}) {
          const Swept swept = swept_rates(c, x, u, with_twin);
          CHECK(relative_gap(swept.rate, expected.rate) <= 1e-12);
          CHECK(swept.pairs == expected.pairs);
        }
      }
    }
  }
}

/// Positions within one period whose gaps are in proportion to what is given.
std::vector<double> with_gaps(std::vector<double> gap, double period) {
  double sum = 0.0;
  for (const double each : gap) sum += each;
  double position = 0.1;
  for (double& each : gap) position += std::exchange(each, position) * period / sum;
  return gap;
}

}  // namespace

TEST_CASE("A horizon about the smallest gap gives each particle its nearest neighbor and hardly another", "[vector]") {
  const auto scene = random_scene(78);
  const auto x = irregular_positions(61, scene->period(), 9);
  const auto [smallest, largest] = test::gaps(x, scene->period());
  for (const double delta : {1e-200, 0.5 * smallest, smallest, 1.01 * smallest, largest, 1.01 * largest}) {
    check_forms_agree(scene, x, delta);
  }
  const Case c = case_on(scene, 2, true, {"cubic-spline"}, x.size(), 0.99 * smallest);
  CHECK(swept_rates(c, x, irregular_values(x.size(), 8), true).pairs == static_cast<std::int64_t>(2 * x.size()));
}

TEST_CASE("Windows may hold many neighbors on one side and few on the other", "[vector]") {
  const auto scene = random_scene(79);
  std::vector<double> gap;
  for (int i = 0; i < 90; ++i) gap.push_back(1.0);
  for (int i = 0; i < 13; ++i) gap.push_back(25.0);
  for (int i = 0; i < 30; ++i) gap.push_back(3.0);
  const auto x = with_gaps(gap, scene->period());
  const double dense = test::gaps(x, scene->period()).smallest;
  for (const double neighbors : {3.5, 9.5, 24.5, 60.5, 120.5}) check_forms_agree(scene, x, neighbors * dense);
}

TEST_CASE("Several neighbors may tie with the horizon", "[vector]") {
  const auto scene = random_scene(80);
  // Pairs of particles that all but coincide: the second of a pair is a little beyond the horizon of some.
  std::vector<double> gap;
  for (int i = 0; i < 40; ++i) {
    gap.push_back(1.0);
    gap.push_back(1e-13);
  }
  const auto x = with_gaps(gap, scene->period());
  for (const int steps : {1, 2, 3, 11}) check_forms_agree(scene, x, x[2 * steps] - x[0]);
}

TEST_CASE("Velocities at midpoints may have any few modes, in common or not", "[vector]") {
  const auto x = irregular_positions(43, 2.0 * std::numbers::pi, 10);
  for (const auto& [c, b] : {std::pair("0.7", "0.3"), std::pair("0.7", "sin(x)"), std::pair("cos(x)", "sin(x) - 2"),
                             std::pair("sin(x) + cos(3*x)", "0.1"), std::pair("cos(2*x)", "sin(x) + cos(2*x)"),
                             std::pair("sin(x) + cos(2*x) + sin(4*x)", "cos(5*x) - cos(x)")}) {
    CAPTURE(c, b);
    const auto scene = std::make_shared<const Scene>(
        SceneText{.name = {}, .period = "2*pi", .T = "1", .c = c, .b = b, .u = "cos(x - t)", .flow = {}});
    REQUIRE(VelocitySeries(*scene).modes);
    check_forms_agree(scene, x, 0.7);
  }
}

TEST_CASE("With hundreds of neighbors the moments of cells keep their digits", "[vector]") {
  const auto scene = random_scene(81);
  check_forms_agree(scene, irregular_positions(2500, scene->period(), 11), 0.06 * scene->period());
}

namespace {

/// A case with so many neighbors that it is swept in its far form.
Case far_case(const std::shared_ptr<const Scene>& scene, int model, const char* kernel) {
  constexpr std::size_t N = 4000;
  const Case c = case_on(scene, model, true, {kernel}, N, 0.1 * scene->period());
  REQUIRE(plan(c).form->far);
  REQUIRE(far::range_size(c.N, c.delta / c.h) < c.N / 2);
  return c;
}
std::vector<Case> far_cases(const std::shared_ptr<const Scene>& scene) {
  return {far_case(scene, 1, "inverse"), far_case(scene, 1, "cubic-spline"), far_case(scene, 2, "cubic-spline")};
}

}  // namespace

TEST_CASE("A case is run in the first form that takes it", "[vector]") {
  const auto form = [](const Case& c) { return plan(c).form->name; };
  const auto scene = random_scene(5);
  for (Case c : far_cases(scene)) {
    CAPTURE(c.key());
    CHECK(form(c) == "vector with far sums");
    c.delta = 0.01 * scene->period();
    CHECK(form(c) == "vector");
    c.step = {.bound = StepRule::Bound::rows, .safety = 0.5, .text = "cfl"};
    CHECK(form(c) == "vector");
    c.integrator = std::find_if(std::begin(integrators), std::end(integrators), std::mem_fn(&Integrator::implicit));
    CHECK(form(c) == "vector with implicit steps");
    c.delta = 0.1 * scene->period();
    CHECK(form(c) == "vector with implicit steps");
    c.readable = true;
    CHECK(form(c) == "readable with implicit steps");
    c.integrator = &forward_euler;
    CHECK(form(c) == "readable");
  }
}

TEST_CASE("Two cases that share their sums have the form that is the faster for both", "[vector]") {
  const auto scene = random_scene(5);
  const auto names = [&](double neighbors, int model) {
    constexpr std::size_t N = 4000;
    const double delta = neighbors * scene->period() / N;
    const Case local = case_on(scene, model, false, {"cubic-spline"}, N, delta),
               nonlocal = case_on(scene, model, true, {"cubic-spline"}, N, delta);
    const Case* const cases[] = {&local, &nonlocal, &local};
    std::vector<std::string_view> forms;
    for (const Plan& one : plan(cases)) forms.push_back(one.form->name);
    return forms;
  };
  using Names = std::vector<std::string_view>;
  const std::string_view direct = "vector", far = "vector with far sums";
  CHECK(names(200.0, 2) == Names{direct, direct, direct});
  CHECK(names(230.0, 2) == Names{direct, direct, far});
  CHECK(names(230.0, 1) == Names{far, far, far});
  CHECK(names(260.0, 2) == Names{far, far, far});
}

TEST_CASE("Any number of threads gives bitwise the same rates", "[vector]") {
  const auto scene = random_scene(5);
  std::vector<Case> cases = far_cases(scene);
  for (const int model : {1, 2}) cases.push_back(case_on(scene, model, false, {"cubic-spline"}, 1000, 0.1));
  for (const Case& c : cases) {
    const auto N = static_cast<std::size_t>(c.N);
    const auto x = irregular_positions(N, scene->period(), 3);
    const auto u = irregular_values(N, 4);
    const Swept one = swept_rates(c, x, u, true, 1);
    Case implicit = c;
    implicit.integrator = &integrators[3];
    const std::vector<double> solution = swept_solution(implicit, x, u, 0.1, true, 1);
    for (const int threads : {2, 3, 5}) {
      CHECK(swept_solution(implicit, x, u, 0.1, true, threads) == solution);
      const Swept several = swept_rates(c, x, u, true, threads);
      CHECK(several.rate == one.rate);
      CHECK(several.pairs == one.pairs);
    }
  }
}

TEST_CASE("With many neighbors, too, swept rates and pairs are those of the readable form", "[vector]") {
  const auto scene = random_scene(6);
  for (const Case& c : far_cases(scene)) {
    CAPTURE(c.key());
    const auto N = static_cast<std::size_t>(c.N);
    const auto x = irregular_positions(N, scene->period(), 3);
    const auto u = irregular_values(N, 4);
    for (const bool nonlocal : {false, true}) {
      Case form = c;
      form.scheme.nonlocal_divergence = nonlocal;
      const Swept expected = readable_rates(form, x, u);
      for (const bool with_twin : {false, true}) {
        const Swept swept = swept_rates(form, x, u, with_twin);
        CHECK(relative_gap(swept.rate, expected.rate) <= 1e-12);
        CHECK(swept.pairs == expected.pairs);
      }
    }
  }
}
