#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "mms/line/line_trajectories.hpp"
#include "mms/scene.hpp"
#include "solver/line/particles.hpp"
#include "solver/velocity.hpp"
#include "tests/catch.hpp"

using namespace acstudy;
using Catch::Matchers::WithinAbs;

static_assert(ParticleVelocity<Scene>);

namespace {

const SceneText& paper() { return named_scenes().front(); }

SceneText wave() {
  return {.name = "", .period = "2*pi", .T = "1", .c = "1", .b = std::nullopt, .u = "cos(x-t)", .flow = std::nullopt};
}

/// The scene with one member replaced.
SceneText with(const std::string& member, std::string text, SceneText scene = wave()) {
  if (member == "period")
    scene.period = std::move(text);
  else if (member == "T")
    scene.T = std::move(text);
  else if (member == "c")
    scene.c = std::move(text);
  else if (member == "u")
    scene.u = std::move(text);
  else if (member == "b")
    scene.b = std::move(text);
  else
    scene.flow = std::move(text);
  return scene;
}

}  // namespace

TEST_CASE("the paper's scene is that of its section 4") {
  const Scene scene(paper());
  CHECK(scene.text().name == "lee-du-2019");
  CHECK(scene.period() == 2.0 * std::numbers::pi);
  CHECK(scene.T() == 1.0);
  CHECK_FALSE(scene.standing());
  for (const double x : {-1.0, 0.0, 0.3, 2.0, 5.0}) {
    CAPTURE(x);
    double c = 0.0, c_prime = 0.0, b = 0.0, b_prime = 0.0, b_prime_alone = 0.0, u = 0.0, u_x = 0.0, u_t = 0.0;
    scene.c({&x, 1}, {&c, 1}, {&c_prime, 1});
    scene.b({&x, 1}, {&b, 1}, {&b_prime, 1});
    scene.b_prime({&x, 1}, {&b_prime_alone, 1});
    scene.u({&x, 1}, 0.7, {&u, 1}, {&u_x, 1}, {&u_t, 1});
    CHECK_THAT(c, WithinAbs(std::cos(2 * x) / 3, 1e-15));
    CHECK_THAT(c_prime, WithinAbs(-2 * std::sin(2 * x) / 3, 1e-15));
    CHECK_THAT(b, WithinAbs(std::sin(x), 1e-15));
    CHECK_THAT(b_prime, WithinAbs(std::cos(x), 1e-15));
    CHECK(b_prime_alone == b_prime);
    CHECK_THAT(u, WithinAbs(std::cos(x - 0.7), 1e-15));
    CHECK_THAT(u_x, WithinAbs(-std::sin(x - 0.7), 1e-15));
    CHECK_THAT(u_t, WithinAbs(std::sin(x - 0.7), 1e-15));
  }
}

TEST_CASE("the closed flow is the integrated one, forth and back in time") {
  SceneText without_flow = paper();
  without_flow.flow.reset();
  const Scene closed(paper()), integrated(without_flow);
  REQUIRE(closed.flow().has_value());
  REQUIRE_FALSE(integrated.flow().has_value());
  const auto start = uniform_positions(64, closed.period());
  Trajectories exact(closed, start), numerical(integrated, start);
  for (const double t : {0.0, 0.1, 1.0, 0.5, 0.5, 0.0, 1.0, 0.99}) {
    CAPTURE(t);
    const auto a = exact.at(t);
    const auto b = numerical.at(t);
    double worst = 0.0;
    // The closed flow takes x to (-pi, pi]: compare up to the period.
    for (std::size_t j = 0; j < a.size(); ++j) {
      worst = std::max(worst, std::abs(std::remainder(a[j] - b[j], closed.period())));
    }
    CHECK(worst < 1e-12);
    CHECK(std::is_sorted(a.begin(), a.end()));
    CHECK(std::is_sorted(b.begin(), b.end()));
    CHECK(a.back() < a.front() + closed.period());
  }
  // Fixed points of the flow.
  CHECK(numerical.at(1.0)[0] == 0.0);
  CHECK_THAT(numerical.at(1.0)[32], WithinAbs(std::numbers::pi, 1e-14));
}

TEST_CASE("particles come with the phases of their positions, from pieces as from the whole") {
  SceneText short_period = paper(), by_sine = paper(), translation = with("b", "1.5");
  short_period.period = "1";
  short_period.c = "cos(4*pi*x)/3";
  short_period.b = "sin(2*pi*x)/(2*pi)";
  short_period.u = "cos(2*pi*(x - t))";
  short_period.flow = "atan2(sin(pi*x)*exp(t), cos(pi*x))/pi";
  by_sine.flow = "x + 2*atan2((exp(t) - 1)*sin(x/2)*cos(x/2), cos(x/2)^2 + exp(t)*sin(x/2)^2)";
  translation.flow = "x + 1.5*t";
  SceneText at_rest = with("b", "1e-200*1e-200*x");
  at_rest.flow = "2*atan2(sin(x/2), cos(x/2))";
  for (const SceneText& text : {paper(), short_period, by_sine, translation, at_rest}) {
    CAPTURE(*text.flow);
    const Scene scene(text);
    const bool moves_as_angle = text.flow->find('x') != 0 && text.flow != at_rest.flow;
    CHECK(scene.flow()->angle(scene.period() / std::numbers::pi).has_value() == moves_as_angle);
    constexpr std::size_t count = 301;
    LineTrajectories trajectories(scene, uniform_positions(count, scene.period()));
    std::vector<double> x(count), C(count), S(count), half_C(count), half_S(count);
    const PhasesOut all{C, S, half_C, half_S};
    trajectories.at(0.6, 0, x, all);
    const auto expected = trajectories.at(0.6);
    for (std::size_t j = 0; j < count; ++j) {
      const double phase = 2.0 * std::numbers::pi * x[j] / scene.period();
      CHECK_THAT(x[j], WithinAbs(expected[j], 4e-16 * scene.period()));
      CHECK_THAT(C[j], WithinAbs(std::cos(phase), 4e-15));
      CHECK_THAT(S[j], WithinAbs(std::sin(phase), 4e-15));
      CHECK_THAT(half_C[j], WithinAbs(std::cos(0.5 * phase), 2e-15));
      CHECK_THAT(half_S[j], WithinAbs(std::sin(0.5 * phase), 2e-15));
    }
    std::vector<double> part(71), part_C(71), part_S(71);
    trajectories.at(0.6, 40, part, {part_C, part_S, {}, {}});
    for (std::size_t j = 0; j < part.size(); ++j) {
      CHECK(part[j] == x[40 + j]);
      CHECK(part_C[j] == C[40 + j]);
      CHECK(part_S[j] == S[40 + j]);
    }
  }
}

TEST_CASE("the integrated flow of constant b is a translation without wrapping") {
  const Scene scene(with("b", "1.5"));
  Trajectories trajectories(scene, {0.0, 1.0, 6.0});
  const auto x = trajectories.at(1.0);
  CHECK_THAT(x[0], WithinAbs(1.5, 1e-13));
  CHECK_THAT(x[2], WithinAbs(7.5, 1e-13));
}

TEST_CASE("max_relative_velocity is the maximum of |c - b|") {
  // |cos(2x)/3 - sin x| = 4/3 at x = pi/2.
  CHECK_THAT(Scene(paper()).max_relative_velocity(), WithinAbs(4.0 / 3.0, 1e-15));
  CHECK(Scene(wave()).max_relative_velocity() == 1.0);
  // The maximum lies between sample points.
  CHECK_THAT(Scene(with("c", "2 + cos(x - 0.1234)")).max_relative_velocity(), WithinAbs(3.0, 1e-14));
  CHECK_THAT(Scene(with("c", "-2 - cos(x - 0.1234)")).max_relative_velocity(), WithinAbs(3.0, 1e-14));
  CHECK(Scene(with("b", "sin(x)", with("c", "sin(x)"))).max_relative_velocity() == 0.0);
}

TEST_CASE("particles stand still where b is absent or zero") {
  CHECK(Scene(wave()).standing());
  for (const std::string b : {"0", "0.0", "1 - 1"}) {
    CAPTURE(b);
    CHECK(Scene(with("b", b)).standing());
  }
  for (const std::string b : {"1", "sin(x)"}) {
    CAPTURE(b);
    CHECK_FALSE(Scene(with("b", b)).standing());
  }
}

TEST_CASE("a scene may end where it starts") {
  SceneText still = paper();
  still.T = "0";
  const Scene scene(still);
  CHECK(scene.T() == 0.0);
  Trajectories trajectories(scene, {0.5, 1.0});
  CHECK(trajectories.at(scene.T())[1] == 1.0);
}

TEST_CASE("every named scene is sound") {
  std::vector<std::string> names;
  for (const SceneText& text : named_scenes()) {
    CAPTURE(text.name);
    CHECK_NOTHROW(Scene(text));
    CHECK_FALSE(text.name.empty());
    CHECK(std::find(names.begin(), names.end(), text.name) == names.end());
    names.push_back(text.name);
  }
}

TEST_CASE("a scene that does not keep its promises is refused with field and reason") {
  const struct {
    SceneText scene;
    std::string field, message;
    std::size_t position = 0;
  } table[] = {
      {with("c", "x"), "c", "c is not periodic: c(x + 6.28319) and c(x) differ by 6.28"},
      {with("u", "cos(x/2)"), "u", "u is not periodic: u(x + 6.28319) and u(x) differ by 2"},
      {with("b", "sin(x/2)"), "b", "b is not periodic: b(x + 6.28319) and b(x) differ by 2"},
      {with("u", "cos(x) + (t > 0)"), "u", "unexpected \">\"; an expression has no conditions", 12},
      {with("c", "1/sin(x)"), "c", "c is inf at x = 0; it must be finite everywhere"},
      {with("u", "1/(t - 1)"), "u", "u is inf at x = 0; it must be finite everywhere"},
      {with("T", "-1"), "T", "T = -1; it must be zero or positive and finite"},
      {with("T", "1/0"), "T", "T = inf; it must be zero or positive and finite"},
      {with("T", "0", with("u", "1/x")), "u", "u is inf at x = 0; it must be finite everywhere"},
      {with("T", "0", with("flow", "x + t", with("b", "sin(x)"))), "flow",
       "the flow does not follow b: its velocity differs from b by 2 at t = 0; leave it out to have it integrated"},
      {with("period", "-2*pi"), "period", "period = -6.28319; it must be positive and finite"},
      {with("flow", "x"), "flow", "a flow without b; particles stand still unless b is given"},
      {with("flow", "x + 1", with("b", "sin(x)")), "flow",
       "the flow at t = 0 takes x = 0 to 1; it must leave it there"},
      {with("flow", "x + t", with("b", "sin(x)")), "flow",
       "the flow does not follow b: its velocity differs from b by 2 at t = 0; leave it out to have it integrated"},
      {with("flow", "x + t*sin(x)", with("b", "sin(x)")), "flow",
       "the flow does not follow b: its velocity differs from b by 0.21 at t = 0.37; leave it out to have it "
       "integrated"},
      {with("flow", "pi + atan2(sin(x + t - pi), cos(x + t - pi))", with("b", "1")), "flow",
       "the flow does not keep particles in order at t = 0.37; it may jump where it wraps around the period"},
      {with("c", "sin(y)"), "c", "unknown name \"y\"; it may use x, pi, e and the usual functions", 4},
      {with("c", "t"), "c", "unknown name \"t\"; it may use x, pi, e and the usual functions"},
      {with("u", "cos(x"), "u", "a closing parenthesis is missing", 4},
  };
  CHECK_NOTHROW(Scene(wave()));
  for (const auto& [scene, field, message, position] : table) {
    INFO("expected: " << message);
    try {
      const Scene accepted(scene);
      FAIL_CHECK("accepted");
    } catch (const SceneError& error) {
      CHECK(error.field == field);
      CHECK(error.what() == message);
      CHECK(error.position == position);
    }
  }
}
