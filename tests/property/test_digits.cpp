#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "solver/line/model1.hpp"
#include "solver/line/model2.hpp"
#include "studies/claims/digits.hpp"
#include "tests/catch.hpp"
#include "tests/irregular_particles.hpp"
#include "tests/velocities.hpp"

using namespace acstudy;
using namespace acstudy::test;

namespace {

/// A bound that is as far from what is measured, some 1e-15, as from the bound of the study.
constexpr double few_units = 1e-14;
const std::vector<double> ratios = {1e-12, 0.5, 1.0, 2.5, 10.0, 33.3, 300.0};

double largest(const Finding& finding) {
  double value = 0.0;
  for (const Point& point : finding.points) value = std::isnan(point.value) ? HUGE_VAL : std::fmax(value, point.value);
  return value;
}

template <class Check>
void for_each_choice(Check check) {
  for (const char* const name : {"inverse", "cubic-spline"}) check(WeightsChoice{&model_one, {name}});
  for (const double alpha : {-2.0, 0.0, 0.9, 1.0, 1.99}) check(WeightsChoice{&model_one, {"power", alpha}});
  check(WeightsChoice{&model_two, {"cubic-spline"}});
  for (const double alpha : {-2.0, 0.5, 0.99}) check(WeightsChoice{&model_two, {"power", alpha}});
}

}  // namespace

TEST_CASE("weights and N_j agree with 50 digits, from horizons below every gap to 300 h", "[digits]") {
  for_each_choice([](const WeightsChoice& choice) {
    INFO(choice.model->name << ", " << choice.kernel.label());
    const Finding weights = round_off_of_weights(choice, ratios, CellForm::factored).take();
    CHECK(weights.points.size() == ratios.size());
    CHECK(weights.judgement.verdict == Verdict::holds);
    CHECK(largest(weights) < few_units);
    if (choice.model == &model_one) return;
    const Finding renormalization = round_off_of_renormalization(choice, ratios).take();
    CHECK(renormalization.judgement.verdict == Verdict::holds);
    CHECK(largest(renormalization) < few_units);
  });
}

TEST_CASE("plain sums of N_j over 2e4 neighbors keep their digits", "[digits]") {
  const Finding finding = round_off_of_renormalization({&model_two, {"cubic-spline"}}, {1e4}).take();
  CHECK(finding.judgement.verdict == Verdict::holds);
  CHECK(largest(finding) < few_units);
}

TEST_CASE("negative control: differences of closed forms lose digits, and it is seen", "[digits]") {
  for_each_choice([](const WeightsChoice& choice) {
    INFO(choice.model->name << ", " << choice.kernel.label());
    const Finding finding = round_off_of_weights(choice, ratios, CellForm::difference).take();
    CHECK(finding.judgement.verdict == Verdict::violated);
    CHECK(finding.expected == Verdict::violated);
    CHECK(largest(finding) > 1e-9);
  });
}

TEST_CASE("what is examined are the weights of the models", "[digits]") {
  constexpr double period = 1.0;
  const auto x = irregular_positions(50, period, 3);
  const double delta = 0.17;
  const Particles particles = placed(x, period, delta);
  ModelI<PowerKernel, NoDivergence> first(PowerKernel(1.9));
  ModelII<IntegrablePowerKernel, NoDivergence> second(IntegrablePowerKernel(0.9), 1.0);
  for (const double c : {1.0, -1.0}) {
    first.place(particles, constant_velocity(c));
    second.place(particles, constant_velocity(c));
    for (std::size_t j = 0; j < x.size(); ++j) {
      const auto at = static_cast<std::ptrdiff_t>(j);
      const int l = particles.windows.left[j], r = particles.windows.right[j];
      std::vector<double> W(static_cast<std::size_t>(c > 0.0 ? l : r)), m(static_cast<std::size_t>(l + r));
      c > 0.0 ? upwind_weights<+1>(PowerKernel(1.9), particles.x.at(at), delta, W)
              : upwind_weights<-1>(PowerKernel(1.9), particles.x.at(at), delta, W);
      const auto of_model = first.weights(at);
      CHECK(W == std::vector<double>(of_model.begin(), of_model.end()));
      const IntegrablePowerKernel kernel(0.9);
      const double moment = set_masses<-1>(kernel, particles.x.at(at), delta, l, m.data() + l - 1) +
                            set_masses<+1>(kernel, particles.x.at(at), delta, r, m.data() + l);
      CHECK(second.renormalization(at) == moment / (2.0 * delta));
      for (std::size_t k = 0; k < m.size(); ++k) m[k] *= (k < static_cast<std::size_t>(l) ? -1.0 : 1.0) / (2.0 * delta);
      CHECK(relative_gap(second.weights(at), m) < 4e-16);
    }
  }
}

TEST_CASE("gaps of the paper's flow lose the digits of a position relative to a gap", "[digits]") {
  const auto scene = std::make_shared<const Scene>(named_scenes().front());
  REQUIRE(scene->text().b == "sin(x)");
  const Finding finding = round_off_of_gaps(scene, 200, {1.0, 8.0}).take();
  REQUIRE(finding.points.size() == 2);
  CHECK(finding.judgement.verdict == Verdict::holds);
  // Smallest gaps are e^-t h.
  CHECK(finding.points[0].value < 1e-12);
  CHECK(finding.points[1].value > 1e-12);
  CHECK(finding.points[1].value < 1e-9);
  // Negative control: another flow.
  SceneText text = scene->text();
  text.b = "sin(x)*1.0000001";
  text.flow.reset();
  CHECK(round_off_of_gaps(std::make_shared<const Scene>(text), 200, {1.0}).take().judgement.verdict ==
        Verdict::violated);
}
