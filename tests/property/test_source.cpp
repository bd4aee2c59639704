#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "mms/source.hpp"
#include "tests/catch.hpp"

using namespace acstudy;
using Catch::Matchers::WithinAbs;

namespace {

/// Points across the period, none of them where a velocity of the named scenes changes sign: there the side that
/// Model I looks to is decided by round-off.
std::vector<double> points_of(const Scene& scene, int count) {
  std::vector<double> x;
  for (int i = 0; i < count; ++i) x.push_back(scene.period() * (i + 0.137) / count);
  return x;
}

std::vector<double> values(Source& source, const std::vector<double>& x, double t) {
  std::vector<double> f(x.size());
  source.place(x);
  source.evaluate(t, f);
  return f;
}

double gap(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0.0, scale = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    worst = std::max(worst, std::isfinite(a[i]) ? std::abs(a[i] - b[i]) : INFINITY);
    scale = std::max(scale, std::abs(b[i]));
  }
  return worst / scale;
}

template <class Check>
void for_each_model(Check check) {
  const auto both_divergences = [&](const std::string& name, const ContinuumModel& model, const KernelProfile& kernel) {
    for (const bool nonlocal : {false, true}) {
      check((&model == &upwind_continuum ? "Model I, " : "Model II, ") + name +
                (nonlocal ? ", nonlocal divergence" : ", local divergence"),
            NonlocalModel{&model, nonlocal, kernel, 0.0, &model == &viscous_continuum ? 4.0 / 3.0 : 0.0});
    }
  };
  both_divergences("inverse", upwind_continuum, profile(InverseKernel{}));
  both_divergences("power 1.5", upwind_continuum, profile(PowerKernel(1.5)));
  both_divergences("power -1", upwind_continuum, profile(PowerKernel(-1.0)));
  both_divergences("cubic spline", upwind_continuum, profile(CubicSplineKernel{}));
  both_divergences("power 0.5", viscous_continuum, profile(IntegrablePowerKernel(0.5)));
  both_divergences("power -1", viscous_continuum, profile(IntegrablePowerKernel(-1.0)));
  both_divergences("cubic spline", viscous_continuum, profile(CubicSplineKernel{}));
}

}  // namespace

TEST_CASE("the local source is u_t + (c u)_x") {
  const struct {
    std::size_t scene;
    double (*f)(double, double);
  } table[] = {
      {0,
       [](double x, double t) {
         return std::sin(x - t) - 2.0 / 3.0 * std::sin(2 * x) * std::cos(x - t) -
                std::cos(2 * x) / 3.0 * std::sin(x - t);
       }},
      {1,
       [](double x, double t) {
         return -std::cos(x - t) + 0.5 * std::cos(x) * (std::sin(x - t) + std::cos(2 * x) / 4) +
                (1 + 0.5 * std::sin(x)) * (std::cos(x - t) - 0.5 * std::sin(2 * x));
       }},
      {2, [](double, double) { return 0.0; }},
      {3,
       [](double x, double t) {
         return std::sin(x - t) + std::cos(x) * (2 + std::cos(x - t)) - std::sin(x) * std::sin(x - t);
       }},
  };
  REQUIRE(named_scenes().size() == std::size(table));
  for (const auto& [index, f] : table) {
    const Scene scene(named_scenes()[index]);
    const auto source = local_source(scene);
    const auto x = points_of(scene, 101);
    for (const double t : {0.0, 0.3, 1.0}) {
      const auto computed = values(*source, x, t);
      for (std::size_t j = 0; j < x.size(); ++j) {
        CAPTURE(scene.text().name, t, x[j]);
        CHECK_THAT(computed[j], WithinAbs(f(x[j], t), 1e-14));
      }
    }
    CHECK(source->quadrature_points() == 0);
  }
}

TEST_CASE("the fixed rule agrees with adaptive quadrature of the definitions, on every scene, model and horizon") {
  for (const SceneText& text : named_scenes()) {
    const Scene scene(text);
    const auto x = points_of(scene, 3);
    for_each_model([&](const std::string& name, NonlocalModel model) {
      // Where nothing moves the two divergences are the same by definition.
      if (scene.standing() && model.nonlocal_divergence) return;
      for (const double delta : {1e-7, 1e-3, 0.2, 2.5}) {
        model.delta = delta;
        INFO(text.name << ", " << name << ", delta = " << delta);
        // Where u solves the PDE the source itself is a round-off of its terms for small delta: take enough points.
        const bool cancels = text.name == "constant-velocity" && delta < 0.1;
        const auto gauss = values(cancels ? *nonlocal_source(scene, model, 8) : *nonlocal_source(scene, model), x, 0.6);
        // 1e-13 of the largest value, or of the fields' own scale, one, where the source cancels.
        const auto agree = [&](SourceRule rule) {
          const auto adaptive = values(*nonlocal_source(scene, model, rule), x, 0.6);
          double worst = 0.0, scale = 1.0;
          for (std::size_t j = 0; j < x.size(); ++j) {
            worst = std::max(worst, std::isfinite(adaptive[j]) ? std::abs(gauss[j] - adaptive[j]) : INFINITY);
            scale = std::max(scale, std::abs(adaptive[j]));
          }
          return worst / scale;
        };
        CHECK(agree(SourceRule::gsl) < 1e-13);
        CHECK(agree(SourceRule::boost) < 1e-13);
      }
    });
  }
}

TEST_CASE("where particles stand still the form of the divergence is of no matter") {
  const Scene scene(named_scenes()[1]);
  const auto x = points_of(scene, 40);
  for (const ContinuumModel* const continuum : {&upwind_continuum, &viscous_continuum}) {
    NonlocalModel model{continuum, false, profile(CubicSplineKernel{}), 0.2, 1.5};
    const auto local = values(*nonlocal_source(scene, model), x, 0.3);
    model.nonlocal_divergence = true;
    CHECK(values(*nonlocal_source(scene, model), x, 0.3) == local);
  }
  // Where they move it is.
  const Scene moving(named_scenes()[0]);
  NonlocalModel model{&upwind_continuum, false, profile(CubicSplineKernel{}), 0.2, 0.0};
  const auto local = values(*nonlocal_source(moving, model), x, 0.3);
  model.nonlocal_divergence = true;
  CHECK(gap(values(*nonlocal_source(moving, model), x, 0.3), local) > 1e-3);
}

TEST_CASE("as delta -> 0 the nonlocal source tends to the local one at first order") {
  const Scene scene(named_scenes()[0]);
  const auto x = points_of(scene, 60);
  const auto local = values(*local_source(scene), x, 0.6);
  for_each_model([&](const std::string& name, NonlocalModel model) {
    std::vector<double> error;
    for (const double delta : {1e-2, 5e-3, 2.5e-3, 1.25e-3, 6.25e-4}) {
      model.delta = delta;
      error.push_back(gap(values(*nonlocal_source(scene, model), x, 0.6), local));
    }
    INFO(name);
    CAPTURE(error);
    for (std::size_t i = 1; i < error.size(); ++i) CHECK_THAT(std::log2(error[i - 1] / error[i]), WithinAbs(1.0, 0.05));
    model.delta = 1e-12;
    CHECK(gap(values(*nonlocal_source(scene, model), x, 0.6), local) < 1e-11);
  });
}

TEST_CASE("without viscosity Model II is second order in delta: w is odd") {
  const Scene scene(named_scenes()[0]);
  const auto x = points_of(scene, 60);
  const auto local = values(*local_source(scene), x, 0.6);
  NonlocalModel model{&viscous_continuum, true, profile(CubicSplineKernel{}), 0.0, 0.0};
  std::vector<double> error;
  for (const double delta : {0.1, 0.05, 0.025, 0.0125}) {
    model.delta = delta;
    error.push_back(gap(values(*nonlocal_source(scene, model), x, 0.6), local));
  }
  CAPTURE(error);
  for (std::size_t i = 1; i < error.size(); ++i) CHECK_THAT(std::log2(error[i - 1] / error[i]), WithinAbs(2.0, 0.05));
}

TEST_CASE("the number of Gauss points is the fewest that reach round-off") {
  const Scene scene(named_scenes()[0]);
  const auto x = points_of(scene, 33);
  for_each_model([&](const std::string& name, NonlocalModel model) {
    for (const double delta : {1e-3, 0.2}) {
      model.delta = delta;
      const auto chosen = nonlocal_source(scene, model);
      const auto f = values(*chosen, x, 0.6);
      const std::size_t sides = model.continuum == &upwind_continuum ? 1 : 4;  // Model II: two sides, two rules
      const auto points = static_cast<std::size_t>(chosen->quadrature_points()) / (x.size() * sides);
      INFO(name << ", delta = " << delta << ", " << points << " points");
      CHECK(chosen->quadrature_points() == static_cast<std::int64_t>(points * x.size() * sides));
      CHECK(points >= 2);
      CHECK(points <= 12);
      const auto reference = values(*nonlocal_source(scene, model, 44), x, 0.6);
      CHECK(gap(f, reference) < 1e-13);
      if (points > 2) CHECK(gap(values(*nonlocal_source(scene, model, points - 1), x, 0.6), reference) > 1e-14);
    }
    // Each evaluation counts.
    model.delta = 0.2;
    const auto source = nonlocal_source(scene, model, 7);
    values(*source, x, 0.1);
    const std::int64_t once = source->quadrature_points();
    values(*source, x, 0.2);
    CHECK(source->quadrature_points() == 2 * once);
  });
}

TEST_CASE("fields that vary too fast within the horizon are refused, with the way out") {
  const Scene rough(
      {.name = "", .period = "2*pi", .T = "1", .c = "1", .b = std::nullopt, .u = "cos(400*x)", .flow = std::nullopt});
  NonlocalModel model{&upwind_continuum, false, profile(InverseKernel{}), 2.5, 0.0};
  CHECK_THROWS_AS(nonlocal_source(rough, model), std::domain_error);
  CHECK_THROWS_WITH(nonlocal_source(rough, model),
                    "no Gauss rule of up to 40 points integrates the source at delta = 2.5 to round-off; the fields "
                    "vary too fast within the horizon: use rule = \"gsl\" or \"boost\"");
  CHECK_NOTHROW(nonlocal_source(rough, model, SourceRule::gsl));
}

TEST_CASE("a source that cancels to less than its terms is not mistaken for a rough one") {
  // Here u solves the PDE, so that f is O(delta) and the sum of two terms of order one.
  const Scene scene(named_scenes()[2]);
  CHECK_NOTHROW(nonlocal_source(scene, {&upwind_continuum, false, profile(InverseKernel{}), 1e-4, 0.0}));
}

TEST_CASE("a field that is smooth on the scale of the horizon is not refused, however short its wave") {
  const Scene scene(
      {.name = "", .period = "2*pi", .T = "1", .c = "1", .b = std::nullopt, .u = "cos(400*x)", .flow = std::nullopt});
  CHECK_NOTHROW(nonlocal_source(scene, {&upwind_continuum, false, profile(InverseKernel{}), 1e-3, 0.0}));
}

TEST_CASE("short waves: the adaptive references agree with the fixed rule below and above their switch of formulas") {
  const Scene scene(
      {.name = "", .period = "2*pi", .T = "1", .c = "1", .b = std::nullopt, .u = "cos(100*x)", .flow = std::nullopt});
  const std::vector<double> x = {0.3, 1.7, 4.4};
  for (const ContinuumModel* const continuum : {&upwind_continuum, &viscous_continuum}) {
    for (const double delta : {1e-3, 0.0099, 0.1}) {
      const NonlocalModel model{continuum, false, profile(CubicSplineKernel{}), delta, 1.0};
      const auto f = values(*nonlocal_source(scene, model), x, 0.6);
      for (const SourceRule rule : {SourceRule::gsl, SourceRule::boost}) {
        CAPTURE(continuum->sided, delta);
        // Round-off of the argument 100 x, and of the differences of u over 1e-3 of the period.
        CHECK(gap(f, values(*nonlocal_source(scene, model, rule), x, 0.6)) < 1e-11);
      }
    }
  }
}

TEST_CASE("a kernel too singular for its Gauss rule is refused, not aborted") {
  const Scene scene(named_scenes()[2]);
  CHECK_THROWS_AS(nonlocal_source(scene, {&upwind_continuum, false, profile(PowerKernel(-200.0)), 0.1, 0.0}),
                  std::domain_error);
}
