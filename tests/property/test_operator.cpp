#include <cmath>
#include <memory>

#include "studies/claims/consistency.hpp"
#include "studies/claims/identities.hpp"
#include "studies/claims/stability.hpp"
#include "studies/models/operator.hpp"
#include "tests/catch.hpp"
#include "tests/irregular_particles.hpp"
#include "tests/named_scene.hpp"

namespace acstudy {
namespace {

Subject subject(int model, KernelChoice kernel, Arrangement arrangement, const std::string& name = "lee-du-2019",
                bool nonlocal = false) {
  const auto on = test::named_scene(name);
  return {{.model = find_model(model),
           .nonlocal_divergence = nonlocal,
           .kernel = std::move(kernel),
           .mu = {},
           .control = {}},
          on->max_relative_velocity(),
          on,
          arrangement};
}

const KernelChoice inverse{"inverse"}, spline{"cubic-spline"}, steep{"power", 0.9};

/// Another scheme's weights and rates, with a mistake.
class Mistaken : public LineScheme {
 public:
  explicit Mistaken(std::unique_ptr<LineScheme> scheme) : right_(std::move(scheme)) {}
  void place(const Particles& particles) override { right_->place(particles); }
  void rate(PeriodicArray& u, std::span<double> du) override {
    right_->rate(u, du);
    for (std::size_t j = 0; j < du.size(); ++j) du[j] *= 1.5;
  }
  Stencil stencil(std::ptrdiff_t j) const override { return right_->stencil(j); }
  std::ptrdiff_t reach() const override { return right_->reach(); }
  const SchemeRows* rows() const override { return nullptr; }
  WorkCounts work() const override { return right_->work(); }

 private:
  std::unique_ptr<LineScheme> right_;
};

/// Column by column, with no band.
std::vector<std::vector<double>> dense(PlacedScheme& placed) {
  const std::size_t n = placed.size();
  std::vector<std::vector<double>> matrix(n, std::vector<double>(n));
  std::vector<double> unit(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    unit[i] = 1.0;
    const std::vector<double> column = placed.rate(unit);
    unit[i] = 0.0;
    for (std::size_t j = 0; j < n; ++j) matrix[j][i] = column[j];
  }
  return matrix;
}

TEST_CASE("rows of an operator and the norm of a step are those found unit vector by unit vector", "[operator]") {
  for (const int model : {1, 2}) {
    for (const std::size_t n : {7U, 24U, 50U}) {
      for (const double delta : {0.02, 0.4, 1.1, 2.9}) {
        const Subject one = subject(model, spline, Arrangement::uniform, "lee-du-2019", true);
        const std::vector<double> x = test::irregular_positions(n, one.scene->period(), 3);
        PlacedScheme placed(one.scheme, *one.scene, one.mu, x, delta);
        const auto matrix = dense(placed);
        const PlacedScheme::Rows rows = placed.rows();
        double sum = 0.0, dense_sum = 0.0, norm = 0.0;
        const double dt = 0.03;
        for (std::size_t j = 0; j < n; ++j) {
          double row = 0.0;
          for (std::size_t k = 0; k < rows.width; ++k) {
            const auto i = (static_cast<std::ptrdiff_t>(j + n) + rows.first + static_cast<std::ptrdiff_t>(k)) %
                           static_cast<std::ptrdiff_t>(n);
            CHECK(rows(j, k) == matrix[j][static_cast<std::size_t>(i)]);
            sum += std::abs(rows(j, k));
          }
          for (std::size_t i = 0; i < n; ++i) {
            dense_sum += std::abs(matrix[j][i]);
            row += std::abs((i == j ? 1.0 : 0.0) + dt * matrix[j][i]);
          }
          norm = std::max(norm, row);
        }
        // Nothing lies outside of the band.
        CHECK(sum == Approx(dense_sum).epsilon(1e-13));
        CHECK(step_norm(placed, dt) == Approx(norm).epsilon(1e-13));
      }
    }
  }
}

TEST_CASE("the norm of a step says which operator it is of", "[operator]") {
  const Subject one = subject(1, inverse, Arrangement::uniform, "constant-velocity");
  const std::vector<double> x = one.positions(40).front();
  PlacedScheme right(one.scheme, *one.scene, 0.0, x, 0.01);
  const double dt = largest_step(one, right, StepCondition::printed);
  CHECK(dt == Approx(1.0 / 40.0));
  CHECK(step_norm(right, dt) == Approx(1.0).epsilon(1e-14));
  PlacedScheme wrong(std::make_unique<Mistaken>(make_scheme(one.scheme, *one.scene, 0.0)), *one.scene, x, 0.01);
  CHECK(step_norm(wrong, dt) == Approx(2.0).epsilon(1e-14));
}

TEST_CASE("bounds of a scene's fields are those of its formulas", "[operator]") {
  // c - b = cos(2x)/3 - sin(x), b = sin(x), u = cos(x - t)
  const FieldBounds bounds = field_bounds(*test::named_scene("lee-du-2019"), 0.3);
  CHECK(bounds.c_hat == Approx(1.001 * 4.0 / 3.0).epsilon(1e-5));
  CHECK(bounds.c_hat_2 == Approx(1.001 * 7.0 / 3.0).epsilon(1e-5));
  for (const double one : {bounds.b_1, bounds.b_2, bounds.u, bounds.u_1, bounds.u_2, bounds.u_3}) {
    CHECK(one == Approx(1.001).epsilon(1e-5));
  }
}

TEST_CASE("estimates hold with derived constants, and not of a mistaken scheme", "[operator]") {
  const Resolutions resolutions{{80, 160, 320}, {0.01, 0.7, 2.0, 10.0}, {}};
  for (const int model : {1, 2}) {
    for (const Arrangement arrangement : arrangements) {
      for (const LemmaEstimate& estimate : find_model(model)->estimates) {
        const Finding finding =
            consistency_whatever_delta(subject(model, spline, arrangement, "lee-du-2019", true), estimate, resolutions)
                .take();
        INFO(finding.label() << ": " << finding.judgement.reason);
        CHECK(finding.judgement.verdict == Verdict::holds);
      }
    }
  }
  // Model I is within half the largest second derivative of its flux times h, and comes to it.
  const Finding sharp =
      consistency_whatever_delta(subject(1, inverse, Arrangement::uniform), model_one.estimates[0], resolutions).take();
  for (const Point& point : sharp.points) CHECK(point.value > 0.99 * point.upper);

  for (const int model : {1, 2}) {
    const Subject one = subject(model, spline, Arrangement::uniform);
    for (const LemmaEstimate& estimate : find_model(model)->estimates) {
      if (estimate.viscous) continue;
      const Finding right = consistency_whatever_delta(one, estimate, {{320}, {2.0}, {}}).take();
      const auto x = one.positions(320).front();
      PlacedScheme wrong(std::make_unique<Mistaken>(make_scheme(one.scheme, *one.scene, 0.0)), *one.scene, x,
                         right.points[0].delta);
      const auto source = make_source(one.scheme, *one.scene, 0.0, estimate.nonlocal, right.points[0].delta);
      CHECK(max_norm(wrong.truncation_error(*source, 0.0)) > right.points[0].upper * right.points[0].delta);
    }
  }
}

TEST_CASE("an estimate fails along a path on which it promises nothing", "[operator]") {
  const Subject one = subject(1, inverse, Arrangement::uniform);
  PathChoice path{"delta = 1", Expression("1", {"h", "N"}), {80, 160, 320, 640}, false, {}, {}};
  const LemmaEstimate& pde = model_one.estimates[1];
  CHECK(consistency_along(one, pde, path).take().judgement.verdict != Verdict::holds);
  path.order = 0.0;
  CHECK(consistency_along(one, pde, path).take().judgement.verdict == Verdict::stagnates);
  const LemmaEstimate& nonlocal = model_one.estimates[0];
  path.order = {};
  CHECK(consistency_along(one, nonlocal, path).take().judgement.verdict == Verdict::holds);
}

TEST_CASE("errors that fall more slowly than theory's order do not hold, faster ones do", "[operator]") {
  const auto judged = [](double order, double wobble) {
    Finding finding{Check{.test = Test::rate, .theory_order = 1.0}};
    for (int level = 0; level < 5; ++level) {
      const double h = std::pow(0.5, level);
      finding.points.push_back({.variable = h, .value = std::pow(h, order) * (1.0 + (level % 2 == 0 ? wobble : 0.0))});
    }
    judge(finding);
    return finding.judgement.verdict;
  };
  CHECK(judged(1.0, 0.0) == Verdict::holds);
  CHECK(judged(2.0, 0.0) == Verdict::holds);
  CHECK(judged(0.98, 0.05) == Verdict::holds);
  CHECK(judged(0.85, 0.0) == Verdict::violated);
  CHECK(judged(0.5, 0.05) == Verdict::violated);
  CHECK(judged(0.0, 0.0) == Verdict::stagnates);
}

TEST_CASE("an error that is no number is the worst of all", "[operator]") {
  CHECK(worse(NAN, HUGE_VAL));
  CHECK_FALSE(worse(1.0, NAN));
  Finding finding{};
  finding.points = {{.value = 0.5, .upper = 1.0}, {.value = NAN, .upper = 1.0}};
  judge(finding);
  CHECK(finding.judgement.verdict == Verdict::violated);
}

TEST_CASE("identities of the weights hold, and each of them can fail", "[operator]") {
  const Resolutions resolutions{{40}, {0.01, 1.0, 3.0, 12.0}, {}};
  for (const int model : {1, 2}) {
    const Subject one = subject(model, spline, Arrangement::jittered, "lee-du-2019", true);
    CHECK(weights_are_not_negative(one, resolutions).take().judgement.verdict == Verdict::holds);
    CHECK(first_moment_is_one(one, resolutions).take().judgement.verdict == Verdict::holds);
    CHECK(nearest_neighbor_rows(one, {40}, 0.9).take().judgement.verdict == Verdict::holds);
    CHECK(nearest_neighbor_rows(one, {40}, 4.0).take().judgement.verdict == Verdict::violated);
  }
  const Subject two = subject(2, spline, Arrangement::jittered);
  CHECK(weights_cancel(two, resolutions).take().judgement.verdict == Verdict::holds);
  CHECK(second_moment_is_bounded(two, resolutions, false).take().judgement.verdict == Verdict::holds);
  CHECK(second_moment_is_bounded(two, resolutions, true).take().judgement.verdict == Verdict::holds);
  CHECK(renormalization_is_near_one(two, resolutions).take().judgement.verdict == Verdict::holds);
  CHECK(order_of_renormalization(two, {40, 80, 160, 320}, 0.6).take().judgement.verdict == Verdict::holds);
  CHECK(renormalization_is_at_least_one(two, 16).take().judgement.verdict == Verdict::violated);
  for (const KernelChoice& kernel : {inverse, spline, steep}) {
    CHECK(kernel_moments(kernel).take().judgement.verdict == Verdict::holds);
  }
}

TEST_CASE("a step within its condition is bounded, one beyond is not", "[operator]") {
  const Resolutions resolutions{{60}, {0.01, 1.0, 1.9, 6.0, 20.0}, {}};
  for (const Arrangement arrangement : arrangements) {
    for (const KernelChoice& kernel : {spline, steep}) {
      for (const int model : {1, 2}) {
        const Subject one = subject(model, kernel, arrangement, "lee-du-2019", true);
        INFO(scheme_label(one.scheme, false) << ", " << name_of(arrangement));
        CHECK(step_is_bounded(one, resolutions, StepCondition::corrected).take().judgement.verdict == Verdict::holds);
        CHECK(step_is_bounded(one, resolutions, StepCondition::corrected, 1.5).take().judgement.verdict ==
              Verdict::violated);
        const bool enough = model == 1 || kernel.name == "cubic-spline";
        CHECK(step_is_bounded(one, resolutions, StepCondition::printed).take().judgement.verdict ==
              (enough ? Verdict::holds : Verdict::violated));
      }
    }
  }
  CHECK(printed_condition_on_uneven_gaps(subject(2, spline, Arrangement::uniform), {40}).take().judgement.verdict ==
        Verdict::violated);
}

}  // namespace
}  // namespace acstudy
