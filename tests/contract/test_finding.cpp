#include <cmath>
#include <limits>

#include "catch.hpp"
#include "studies/cases/finding.hpp"

using namespace acstudy;

namespace {

Finding bounded(std::vector<Point> points) {
  Finding finding{};
  finding.points = std::move(points);
  judge(finding);
  return finding;
}

Verdict of(double value, double lower, double upper) {
  return bounded({{.value = value, .lower = lower, .upper = upper}}).judgement.verdict;
}

}  // namespace

TEST_CASE("a bound holds up to its edge and no further") {
  CHECK(of(1.0, 0.0, 1.0) == Verdict::holds);
  CHECK(of(0.0, 0.0, 1.0) == Verdict::holds);
  CHECK(of(std::nextafter(1.0, 2.0), 0.0, 1.0) == Verdict::violated);
  CHECK(of(-1e-300, 0.0, 1.0) == Verdict::violated);
  CHECK(of(0.0, 0.0, 0.0) == Verdict::holds);
}

TEST_CASE("a bound on one side leaves the other open") {
  constexpr double open = std::numeric_limits<double>::infinity();
  CHECK(of(-1e300, -open, 1.0) == Verdict::holds);
  CHECK(of(1e300, 1.0, open) == Verdict::holds);
  CHECK(of(0.5, 1.0, open) == Verdict::violated);
}

TEST_CASE("no bound holds of a value or a bound that is not a number, or of nothing") {
  constexpr double none = std::numeric_limits<double>::quiet_NaN(), open = std::numeric_limits<double>::infinity();
  CHECK(of(none, 0.0, 1.0) == Verdict::violated);
  CHECK(of(0.5, none, 1.0) == Verdict::violated);
  CHECK(of(0.5, 0.0, none) == Verdict::violated);
  CHECK(of(open, 0.0, 1.0) == Verdict::violated);
  CHECK(bounded({}).judgement.verdict == Verdict::violated);
}

TEST_CASE("one point out of its bounds decides, wherever it stands, and is named") {
  for (const std::size_t bad : {0U, 1U, 2U}) {
    std::vector<Point> points(3, Point{.N = 10, .value = 0.5, .lower = 0.0, .upper = 1.0});
    points[bad] = {.N = 77, .value = 2.0, .lower = 0.0, .upper = 1.0};
    const Finding finding = bounded(points);
    CHECK(finding.judgement.verdict == Verdict::violated);
    CHECK(finding.judgement.reason.find("N = 77") != std::string::npos);
  }
}

TEST_CASE("a finding whose values have theory's order is confirmed, and one that must fail raises its alarm") {
  Finding finding{
      Check{.test = Test::order, .theory_order = 1.0, .promised = Verdict::confirmed, .expected = Verdict::confirmed}};
  for (const double h : {0.1, 0.05, 0.025, 0.0125}) finding.points.push_back({.variable = h, .value = 3.0 * h});
  judge(finding);
  CHECK(finding.as_expected());
  CHECK_FALSE(finding.alarm());

  finding.expected = Verdict::below;
  for (Point& point : finding.points) point.value = std::sqrt(point.variable);
  judge(finding);
  CHECK(finding.as_expected());
  CHECK(finding.alarm());
}

TEST_CASE("a bound on an order is met by theory's order, by a higher one and by scatter about it, not by a lower one") {
  const auto rated = [](auto error, double theory) {
    Finding finding{Check{.test = Test::rate, .theory_order = theory}};
    for (const double h : {0.1, 0.05, 0.025, 0.0125}) finding.points.push_back({.variable = h, .value = error(h)});
    judge(finding);
    return finding.judgement.verdict;
  };
  CHECK(rated([](double h) { return h; }, 1.0) == Verdict::holds);
  CHECK(rated([](double h) { return h * h; }, 1.0) == Verdict::holds);
  CHECK(rated([](double h) { return h * (1.0 - 3.0 * h); }, 1.0) == Verdict::holds);
  CHECK(rated([](double h) { return h * (1.0 + 0.05 * std::sin(1.0 / h)); }, 1.0) == Verdict::holds);
  CHECK(rated([](double h) { return std::sqrt(h); }, 1.0) == Verdict::violated);
  CHECK(rated([](double h) { return std::pow(h, 0.9); }, 1.0) == Verdict::violated);
  CHECK(rated([](double h) { return h * std::log(1.0 / h); }, 1.0) != Verdict::holds);
  CHECK(rated([](double h) { return h > 0.02 ? h : 0.05; }, 1.0) != Verdict::holds);
  CHECK(rated([](double h) { return h + 0.01; }, 1.0) != Verdict::holds);
  for (const double D : {10.0, 20.0, 30.0}) {
    CHECK(rated([=](double h) { return std::sqrt(h) * (1.0 + D * h); }, 1.0) != Verdict::holds);
    CHECK(rated([=](double h) { return std::pow(h, 0.7) * (1.0 + D * h); }, 1.0) != Verdict::holds);
  }
  CHECK(rated([](double) { return 0.1; }, 1.0) == Verdict::stagnates);
  CHECK(rated([](double h) { return 1.0 / h; }, 1.0) == Verdict::diverges);
  CHECK(rated([](double h) { return h > 0.02 ? h : NAN; }, 1.0) == Verdict::unstable);

  Finding standstill{Check{.test = Test::rate, .theory_order = 1.0}};
  for (const double error : {0.4, 0.2, 0.1, 0.05}) standstill.points.push_back({.variable = 1.0, .value = error});
  judge(standstill);
  CHECK(standstill.judgement.verdict == Verdict::inconclusive);
}

TEST_CASE("a check is named by statement, subject and spoken coordinates; the unspoken tell apart what has one name") {
  const Check check{.statement = "Lemma 2.4",
                    .subject = "Model II, hat",
                    .coordinates = {{"arrangement", "jittered"}, at_cfl(1.5), unspoken({"mu", 2.0, "mu = 2"})}};
  CHECK(check.label() == "Lemma 2.4: Model II, hat; jittered, CFL 1.5");
  Check other = check, third = check;
  other.coordinates[2] = unspoken({"mu", 3.0, "mu = 3"});
  third.coordinates[1] = at_cfl(1.0);
  CHECK(tell_apart({&other, &third}).empty());
  CHECK(other.label() == check.label());

  Check first = check;
  CHECK(tell_apart({&first, &other, &third}).empty());
  CHECK(first.label() == "Lemma 2.4: Model II, hat; jittered, CFL 1.5, mu = 2");
  CHECK(other.label() == "Lemma 2.4: Model II, hat; jittered, CFL 1.5, mu = 3");
  CHECK(third.label() == "Lemma 2.4: Model II, hat; jittered, CFL 1");

  // Negative control: nothing tells these apart.
  Check same = check, again = check;
  CHECK(tell_apart({&same, &again}) == check.label());
}
