/// Fields, sources, flows, error norms and time stepping on a periodic box: none of them knows of a line.

#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "mms/scene.hpp"
#include "mms/source.hpp"
#include "solver/time/integrate.hpp"
#include "studies/running/outcome.hpp"
#include "tests/catch.hpp"

using namespace acstudy;
using Catch::Matchers::WithinAbs;

namespace {

using Values = std::vector<double>;

constexpr double pi = std::numbers::pi;

/// Particles are compressed and carried along with the solution: c = b.
SceneText carried() {
  return {.name = "",
          .period = "2*pi, 2*pi",
          .T = "1",
          .c = "0.3*sin(x)*cos(y), -0.2*cos(x)*sin(y)",
          .b = "0.3*sin(x)*cos(y), -0.2*cos(x)*sin(y)",
          .u = "cos(x - t)*sin(y) + cos(x + y)/2",
          .flow = std::nullopt,
          .dimension = 2};
}

SceneText with_c(const std::string& c) {
  SceneText text = carried();
  text.b.reset();
  text.c = c;
  return text;
}

/// n x n particles in the middle of cells of one size, shape [2, n n].
Values square(std::size_t n, const std::vector<double>& periods) {
  Values x(2 * n * n);
  for (std::size_t i = 0; i < n * n; ++i) {
    x[i] = periods[0] * (static_cast<double>(i % n) + 0.5) / static_cast<double>(n);
    x[n * n + i] = periods[1] * (static_cast<double>(i / n) + 0.5) / static_cast<double>(n);
  }
  return x;
}

double largest_gap(std::span<const double> a, std::span<const double> b) {
  double gap = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) gap = std::max(gap, std::abs(a[i] - b[i]));
  return gap;
}

/// The method of characteristics: du/dt = f - div b u on particles that move with c = b, and their volumes V' = div b V
/// beside it, all u before all V in the state.
class Characteristics {
 public:
  Characteristics(const Scene& scene, Values start)
      : scene_(scene), trajectories_(scene, std::move(start)), source_(local_source(scene)) {}

  Points at(double t) { return Points::blocks(trajectories_.at(t), scene_.dimension()); }

  void rate(double t, std::span<const double> state, std::span<double> du) {
    see(t);
    for (std::size_t j = 0; j < f_.size(); ++j) {
      du[j] = f_[j] - divergence_[j] * state[j];
      du[f_.size() + j] = divergence_[j] * state[f_.size() + j];
    }
  }
  void solve(double t, double scale, std::span<double> state) {
    see(t);
    for (std::size_t j = 0; j < f_.size(); ++j) {
      state[j] = (state[j] + scale * f_[j]) / (1.0 + scale * divergence_[j]);
      state[f_.size() + j] /= 1.0 - scale * divergence_[j];
    }
  }

 private:
  void see(double t) {
    const Points x = at(t);
    f_.resize(x.size());
    divergence_.resize(x.size());
    source_->place(x);
    source_->evaluate(t, f_);
    scene_.b_prime(x, divergence_);
  }

  const Scene& scene_;
  Trajectories trajectories_;
  std::unique_ptr<Source> source_;
  Values f_, divergence_;
};

}  // namespace

TEST_CASE("a scene of a plane knows its dimension, periods and fields with their derivatives", "[plane]") {
  SceneText text = carried();
  text.period = "2*pi, 4*pi";
  const Scene scene(text);
  CHECK(scene.dimension() == 2);
  CHECK(scene.periods() == Values{2.0 * pi, 4.0 * pi});
  CHECK(scene.volume() == 2.0 * pi * (4.0 * pi));
  CHECK_FALSE(scene.standing());
  const Values x = {0.3, 2.0, 5.0, 1.0, 1.1, 6.0};  // x of three points, then y
  const Points points = Points::blocks(x, 2);
  Values b(6), b_prime(3), u(3), u_x(6), u_t(3);
  scene.b(points, Vectors::blocks(b, 2), b_prime);
  scene.u(points, 0.7, u, Vectors::blocks(u_x, 2), u_t);
  for (std::size_t j = 0; j < 3; ++j) {
    const double X = x[j], Y = x[3 + j], t = 0.7;
    CHECK_THAT(b[j], WithinAbs(0.3 * std::sin(X) * std::cos(Y), 1e-15));
    CHECK_THAT(b[3 + j], WithinAbs(-0.2 * std::cos(X) * std::sin(Y), 1e-15));
    CHECK_THAT(b_prime[j], WithinAbs(0.1 * std::cos(X) * std::cos(Y), 1e-15));
    CHECK_THAT(u[j], WithinAbs(std::cos(X - t) * std::sin(Y) + 0.5 * std::cos(X + Y), 1e-15));
    CHECK_THAT(u_x[j], WithinAbs(-std::sin(X - t) * std::sin(Y) - 0.5 * std::sin(X + Y), 1e-15));
    CHECK_THAT(u_x[3 + j], WithinAbs(std::cos(X - t) * std::cos(Y) - 0.5 * std::sin(X + Y), 1e-15));
    CHECK_THAT(u_t[j], WithinAbs(std::sin(X - t) * std::sin(Y), 1e-15));
  }
  CHECK(Scene(with_c("1, 0")).standing());
  text.b = "0, 0";
  CHECK(Scene(text).standing());
}

TEST_CASE("a scene of a plane that is not sound is refused with its reason", "[plane]") {
  const auto reason = [](const SceneText& text) {
    try {
      const Scene scene(text);
    } catch (const SceneError& error) {
      return error.field + ": " + error.what();
    }
    return std::string();
  };
  CHECK(reason(with_c("1")) == "c: a vector needs 2 components, separated by commas");
  CHECK(reason(with_c("1, 2, 3")) == "c: unexpected comma");
  CHECK(reason(with_c("z, 1")) == "c: unknown name \"z\"; it may use x, y, pi, e and the usual functions");
  CHECK(reason(with_c("1, cos(y/2)")).find("c is not periodic: c(y + 6.28319) and c(y) differ by") !=
        std::string::npos);
  CHECK(reason(with_c("1, 1/sin(y)")).find("c: ") == 0);
  CHECK(reason(with_c("sin(x), abs(sin(y))^0.9")).find("the divergence of c is") != std::string::npos);
  SceneText text = carried();
  text.period = "2*pi";
  CHECK(reason(text) == "period: a vector needs 2 components, separated by commas");
  text.period = "2*pi, 0";
  CHECK(reason(text) == "period: period = 0; it must be positive and finite");
  text = carried();
  text.flow = "x + t, y";
  CHECK(reason(text).find("flow: the flow does not follow b: its velocity differs from b by") == 0);
  text.flow = "x, y + 1";
  CHECK(reason(text).find("flow: the flow at t = 0 takes y = ") == 0);
}

TEST_CASE("flows of a plane are integrated to round-off", "[plane]") {
  SECTION("one with a closed form, against it") {
    SceneText text = carried();
    text.b = "sin(y), 0";
    const Scene integrated(text);
    text.flow = "x + t*sin(y), y";
    const Scene closed(text);
    const Values start = square(9, closed.periods());
    Trajectories exact(closed, start), numerical(integrated, start);
    CHECK(exact.closed_form());
    CHECK_FALSE(numerical.closed_form());
    for (const double t : {0.4, 1.0, 0.2}) CHECK(largest_gap(exact.at(t), numerical.at(t)) <= 4e-13);
    Values x(10), y(10);
    exact.at(0.7, 20, Vectors({x, y}));
    const Points all = Points::blocks(exact.at(0.7), 2);
    CHECK(largest_gap(x, all[0].subspan(20, 10)) == 0.0);
    CHECK(largest_gap(y, all[1].subspan(20, 10)) == 0.0);
  }
  SECTION("rotations, which keep their stream function") {
    SceneText text = carried();
    text.b = "-sin(y), sin(x)";
    const Scene scene(text);
    const Values start = square(8, scene.periods());
    const auto stream = [](const Points& x) {
      Values psi;
      for (std::size_t j = 0; j < x.size(); ++j) psi.push_back(std::cos(x[0][j]) + std::cos(x[1][j]));
      return psi;
    };
    Trajectories turning(scene, start);
    const Values before = stream(Points::blocks(start, 2));
    const auto later = turning.at(50.0);
    CHECK(largest_gap(before, stream(Points::blocks(later, 2))) <= 1e-11);
    CHECK(largest_gap(start, later) > 1.0);
  }
}

TEST_CASE("what is carried along by a flow in the plane converges with the order of the integrator", "[plane]") {
  const Scene scene(carried());
  constexpr std::size_t n = 12, count = n * n;
  for (const Integrator& integrator : integrators) {
    CAPTURE(integrator.name);
    std::vector<double> errors;
    for (const std::int64_t steps : {10, 20, 40}) {
      Characteristics system(scene, square(n, scene.periods()));
      Values state(2 * count, scene.volume() / count), exact(count);
      const std::span<double> u = std::span(state).first(count), volumes = std::span(state).last(count);
      scene.initial(system.at(0.0), u);
      integrate(integrator, state, EqualSteps(scene.T(), steps), system,
                [](std::int64_t, const TimeStep&) { return true; });
      scene.u(system.at(scene.T()), scene.T(), exact);
      const Errors error = errors_of(volumes, scene.volume(), u, exact);
      CHECK(error.l1 <= error.l2);
      CHECK(error.l2 <= error.linf * (1.0 + 1e-12));
      errors.push_back(error.l2);
      double whole = 0.0;
      for (const double volume : volumes) whole += volume;
      CHECK_THAT(whole / scene.volume(), WithinAbs(1.0, integrator.order == 1 ? 1e-2 : 1e-3));
    }
    for (std::size_t k = 0; k + 1 < errors.size(); ++k) {
      CHECK_THAT(std::log2(errors[k] / errors[k + 1]), WithinAbs(integrator.order, 0.12));
    }
  }
}

TEST_CASE("the source of a plane is that of its equation", "[plane]") {
  SceneText text = carried();
  text.c = "0.2 + cos(y)/3 + 0.2*sin(x), sin(x)/3 + 0.2*cos(y)";
  const Scene scene(text);
  const Values x = square(7, scene.periods());
  const Points points = Points::blocks(x, 2);
  Values f(points.size()), given(points.size()), expected;
  const auto source = local_source(scene);
  source->place(points);
  source->evaluate(0.6, f);
  for (std::size_t j = 0; j < points.size(); ++j) {
    const double X = points[0][j], Y = points[1][j], t = 0.6;
    const double u = std::cos(X - t) * std::sin(Y) + 0.5 * std::cos(X + Y);
    const double u_x = -std::sin(X - t) * std::sin(Y) - 0.5 * std::sin(X + Y);
    const double u_y = std::cos(X - t) * std::cos(Y) - 0.5 * std::sin(X + Y);
    expected.push_back(std::sin(X - t) * std::sin(Y) + (0.2 + std::cos(Y) / 3 + 0.2 * std::sin(X)) * u_x +
                       (std::sin(X) / 3 + 0.2 * std::cos(Y)) * u_y + 0.2 * (std::cos(X) - std::sin(Y)) * u);
  }
  CHECK(largest_gap(f, expected) <= 1e-15);
  text.u0 = "sin(y)";
  text.f = "cos(x) - t*sin(y)";
  const Scene unsolved(text);
  const auto of_file = local_source(unsolved);
  of_file->place(points);
  of_file->evaluate(0.6, given);
  for (std::size_t j = 0; j < points.size(); ++j) {
    expected[j] = std::cos(points[0][j]) - 0.6 * std::sin(points[1][j]);
  }
  CHECK(largest_gap(given, expected) <= 1e-15);
}
