#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "solver/line/controls/model1.hpp"
#include "solver/line/controls/model2.hpp"
#include "solver/line/controls/sph.hpp"
#include "solver/line/model1.hpp"
#include "solver/line/model2.hpp"
#include "studies/kinds/study_file.hpp"
#include "studies/models/arrangement.hpp"
#include "studies/models/control_choice.hpp"
#include "studies/models/operator.hpp"
#include "studies/running/run_case.hpp"
#include "tests/catch.hpp"
#include "tests/irregular_particles.hpp"
#include "tests/velocities.hpp"

using namespace acstudy;
using namespace acstudy::test;
using Catch::Matchers::WithinAbs;

namespace {

constexpr double period = 2.0 * std::numbers::pi;
constexpr std::size_t N = 41;
constexpr double h = period / N;
constexpr double horizons[] = {1e-3 * h, h, 2.5 * h, 7.3 * h};

Scene paper_scene() { return Scene(named_scenes().front()); }

/// The largest gap between two schemes' rates on irregular particles, over horizons from below to above the gaps.
template <class A, class B>
double largest_gap(A&& make_a, B&& make_b) {
  double gap = 0.0;
  for (const unsigned seed : {1U, 2U}) {
    for (const double delta : horizons) {
      const Particles particles = placed(irregular_positions(N, period, seed), period, delta);
      auto a = make_a();
      auto b = make_b();
      a.place(particles, uneven_velocity());
      b.place(particles, uneven_velocity());
      const auto u = irregular_values(N, seed + 10);
      gap = std::max(gap, relative_gap(rates(a, u), rates(b, u)));
    }
  }
  return gap;
}

template <class Divergence, class K>
double gap_of_model1(K kernel) {
  return largest_gap([&] { return controls::ModelI<K, Divergence>(kernel); },
                     [&] { return ModelI<K, Divergence>(kernel); });
}

template <class Divergence, class K>
double gap_of_model2(K kernel) {
  return largest_gap([&] { return controls::ModelII<K, Divergence>(kernel, 1.7); },
                     [&] { return ModelII<K, Divergence>(kernel, 1.7); });
}

/// rate of a placed choice on the scene of the paper.
std::vector<double> rate_of(const SchemeChoice& choice, const Scene& scene, const std::vector<double>& x,
                            double delta) {
  PlacedScheme scheme(choice, scene, choice.model == &model_one ? 0.0 : 4.0 / 3.0, x, delta);
  return scheme.rate(irregular_values(x.size(), 5));
}

SchemeChoice choice_of(const Control& control, int model) {
  // With the inverse kernel, point quadrature is cell moments without a tail.
  return {.model = find_model(model),
          .nonlocal_divergence = false,
          .kernel = {"cubic-spline"},
          .mu = std::nullopt,
          .control = &control};
}

}  // namespace

TEST_CASE("a control without a mistake is the scheme") {
  constexpr double round_off = 1e-13;
  CHECK(gap_of_model1<NoDivergence>(InverseKernel{}) <= round_off);
  CHECK(gap_of_model1<LocalDivergence>(InverseKernel{}) <= round_off);
  CHECK(gap_of_model1<NonlocalDivergence>(InverseKernel{}) <= round_off);
  CHECK(gap_of_model1<LocalDivergence>(CubicSplineKernel{}) <= round_off);
  CHECK(gap_of_model1<NonlocalDivergence>(PowerKernel(1.5)) <= round_off);
  CHECK(gap_of_model2<NoDivergence>(CubicSplineKernel{}) <= round_off);
  CHECK(gap_of_model2<LocalDivergence>(CubicSplineKernel{}) <= round_off);
  CHECK(gap_of_model2<NonlocalDivergence>(CubicSplineKernel{}) <= round_off);
  CHECK(gap_of_model2<NonlocalDivergence>(IntegrablePowerKernel(0.5)) <= round_off);
}

TEST_CASE("a control with a mistake is not the scheme") {
  const Scene scene = paper_scene();
  const auto x = arrange(Arrangement::jittered, scene, 60);
  const auto u = irregular_values(x.size(), 5);
  for (const Control& control : named_controls()) {
    for (const int model : {1, 2}) {
      if (control.model != nullptr && control.model->number != model) continue;
      INFO(control.name << ", Model " << model);
      SchemeChoice itself = choice_of(control, model);
      itself.control = nullptr;
      double gap = 0.0;
      for (const double delta : {0.02, 0.3, 1.0}) {
        gap = std::max(
            gap, relative_gap(rate_of(choice_of(control, model), scene, x, delta), rate_of(itself, scene, x, delta)));
        const auto wrong = make_source(choice_of(control, model), scene, 4.0 / 3.0, false, delta);
        const auto right = make_source(itself, scene, 4.0 / 3.0, false, delta);
        std::vector<double> f(x.size()), f_wrong(x.size());
        for (auto* const source : {right.get(), wrong.get()}) source->place(x);
        right->evaluate(0.3, f);
        wrong->evaluate(0.3, f_wrong);
        gap = std::max(gap, relative_gap(f_wrong, f));
      }
      // The trajectories are no part of the operator.
      if (control.flow != nullptr) {
        CHECK(gap == 0.0);
      } else {
        CHECK(gap > 5e-3);
      }
    }
  }
}

TEST_CASE("a control is not stored as its scheme") {
  const auto study = [](const std::string& control) {
    Study parsed = parse_study(R"(
[study]
name = "keys"
[scene]
use = "lee-du-2019"
[[scheme]]
model = 1
divergence = "local"
kernel = "inverse"
[time]
integrator = "forward-euler"
step = "h/4"
[[path]]
name = "delta = 4h"
delta = "4*h"
N = [16]
source = "local"
)",
                               "keys.toml");
    parsed.series[0].cases[0].scheme.control = find_control(control);
    return parsed.series[0].cases[0];
  };
  CHECK(study("downwind").key() != study("").key());
  const std::atomic<bool> stop{false};
  CHECK(run_case(study("downwind"), stop).u != run_case(study(""), stop).u);
}

TEST_CASE("the SPH sum on uniform standing particles is that of the textbook") {
  // sum_i (h) (c_i u_i) d/dx_j W(x_j - x_i), W(r) = (1/s) rho(r/s) with smoothing length s = delta/2.
  const double s = 2.2 * h, step = 1e-5;
  const auto x = uniform_positions(N, period);
  const PointwiseVelocity velocity{[](double y) { return 1.0 + 0.3 * std::sin(y); }};
  const auto u = irregular_values(N, 3);
  const auto rho = [](double z) {
    z = std::abs(z);
    return z <= 1.0 ? 2.0 / 3.0 - z * z + 0.5 * z * z * z : z <= 2.0 ? std::pow(2.0 - z, 3) / 6.0 : 0.0;
  };
  controls::ClassicalSph<CubicSplineKernel, NoDivergence> sph(CubicSplineKernel{}, 0.0);
  const Particles particles = placed(x, period, 2.0 * s);
  sph.place(particles, velocity);
  const auto rate = rates(sph, u);
  for (std::size_t j = 0; j < N; ++j) {
    double sum = 0.0;
    for (std::size_t i = 0; i < N; ++i) {
      const double r = std::remainder(x[j] - x[i], period);
      const double slope = (rho((r + step) / s) - rho((r - step) / s)) / (2.0 * step * s);
      sum += h * velocity.c_at(x[i]) * u[i] * slope;
    }
    // The difference quotient has an error of about step^2/s^4.
    CHECK_THAT(rate[j], WithinAbs(-sum, 1e-7));
  }
}

TEST_CASE("misprinted trajectories obey x' = b(x), but start elsewhere and cross") {
  const Scene scene = paper_scene();
  const auto start = uniform_positions(N, period);  // odd: no two particles on the same trajectory
  MisprintedParticles motion(scene, start);
  const auto at = [&](double t) {
    const auto x = motion.at(t);
    return std::vector<double>(x.begin(), x.end());
  };
  const double step = 1e-4;
  const auto before = at(0.5 - step), x = at(0.5), after = at(0.5 + step), initial = at(0.0);
  double farthest = 0.0;
  for (std::size_t j = 1; j < N; ++j) {
    CHECK_THAT((after[j] - before[j]) / (2.0 * step), WithinAbs(std::sin(x[j]), 1e-7));
    farthest = std::max(farthest, std::abs(initial[j] - start[j]));
  }
  CHECK(farthest > 1.0);
  Particles particles(N, period, 4.0 * h);
  CHECK_THROWS_AS(particles.place(initial), std::domain_error);
  // Put in order, the same positions are sound: it is the names of the particles that are wrong, not the motion.
  std::vector<double> ordered = initial;
  std::sort(ordered.begin(), ordered.end());
  CHECK_NOTHROW(particles.place(ordered));

  SceneText text = scene.text();
  text.flow = misprinted_flow;
  CHECK_THROWS_AS(Scene(text), SceneError);
}
