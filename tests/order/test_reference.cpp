// Errors where no solution is known: against the finest run. The truth comes from scenes whose solution is known.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "studies/cases/series_verdict.hpp"
#include "studies/cases/study_result.hpp"
#include "studies/kinds/study_file.hpp"
#include "studies/models/arrangement.hpp"
#include "studies/models/operator.hpp"
#include "studies/running/outcome.hpp"
#include "studies/running/reference.hpp"
#include "tests/catch.hpp"

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace acstudy {
namespace {

constexpr double period = 2.0 * std::numbers::pi;
using Values = std::vector<double>;

Values smooth(const Values& x) {
  Values u;
  for (const double place : x) u.push_back(std::exp(std::sin(place)));
  return u;
}

double distance(const Values& a, const Values& b) {
  Values gap(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) gap[i] = a[i] - b[i];
  return max_norm(gap);
}

/// The paper's scene, or the same without its solution.
const std::string fields =
    "period = \"2*pi\"\nT = 1\nc = \"cos(2*x)/3\"\nb = \"sin(x)\"\nflow = \"2*atan2(sin(x/2)*exp(t), cos(x/2))\"\n";
const std::string solved = fields + "u = \"cos(x - t)\"\n";
const std::string unsolved = fields +
                             "reference = \"finest\"\nu0 = \"cos(x)\"\n"
                             "f = \"sin(x-t) - 2*sin(2*x)/3*cos(x-t) - cos(2*x)/3*sin(x-t)\"\n";

Study study_of(const std::string& scene, const std::string& path,
               const std::string& scheme = "model = 1\nkernel = \"inverse\"") {
  return parse_study(
      "[study]\nname = \"tiny\"\n[scene]\n" + scene + "[[scheme]]\ndivergence = \"local\"\n" + scheme +
          "\n[time]\nintegrator = \"ssprk2\"\nstep = \"h/4\"\n[[path]]\nname = \"p\"\nsource = \"local\"\n" + path,
      "tiny.toml");
}

CaseResult run(const Case& c) {
  const std::atomic<bool> stop{false};
  return run_case(c, stop);
}

std::vector<CaseResult> run(const Series& series) {
  std::vector<CaseResult> results;
  for (const Case& c : series.cases) results.push_back(run(c));
  return results;
}

Judgement judged(const Series& series, const std::vector<CaseResult>& results) {
  std::vector<Level> levels;
  for (std::size_t i = 0; i < series.levels(); ++i) {
    levels.push_back({series.variable(series.cases[i].h, series.cases[i].delta), results[i].error_linf});
  }
  return judge_errors(levels, series.reference_level(), series.theory.order, {});
}

/// Differences to a reference `beyond` levels finer than the last of `count`; errors are v^p (1 + D v).
struct Differences {
  std::vector<Level> levels;
  ReferenceLevel reference;
};
Differences differences(double p, double D, double ratio, int count, int beyond) {
  const auto error = [&](double v) { return std::pow(v, p) * (1.0 + D * v); };
  const auto variable = [&](int level) { return 0.3 * std::pow(ratio, -level); };
  Differences made{{}, {1000, variable(count - 1 + beyond)}};
  for (int i = 0; i < count; ++i) {
    made.levels.push_back({variable(i), error(variable(i)) - error(made.reference.variable)});
  }
  return made;
}

}  // namespace

TEST_CASE("a solution is interpolated with order 6, on particles at random and across the period", "[reference]") {
  Values at;
  for (int i = 0; i < 500; ++i) at.push_back(-7.0 + 0.04 * i);
  for (const Start& start : {Start{}, Start{Start::Kind::jittered, 0.1, 1}, Start{Start::Kind::clustered, 0.1}}) {
    std::vector<double> errors;
    for (const std::size_t N : {40U, 80U, 160U, 320U}) {
      const Values x = start_positions(start, N, period);
      errors.push_back(distance(interpolate_on_line(x, smooth(x), period, at), smooth(at)));
      if (errors.size() > 1) CHECK(std::log2(errors[errors.size() - 2] / errors.back()) > 5.0);
    }
    CHECK(errors.front() < 2e-3);
    CHECK(errors.back() < 1e-8);
  }
  const Values three = {0.0, 2.0, 4.0};  // a stencil that laps the period
  CHECK(distance(interpolate_on_line(three, {{1.0, 1.0, 1.0}}, period, at), Values(at.size(), 1.0)) < 1e-12);
}

TEST_CASE("particles that nearly coincide do not amplify what their values differ by", "[reference]") {
  Values x = start_positions({Start::Kind::jittered, 1e-6, 3}, 160, period), u = smooth(x);
  for (std::size_t j = 0; j < x.size(); j += 2) u[j] += 1e-3;
  Values between;
  for (std::size_t j = 1; j < x.size(); ++j) between.push_back(0.5 * (x[j - 1] + x[j]));
  CHECK(distance(interpolate_on_line(x, u, period, between), smooth(between)) < 2e-3);
}

TEST_CASE("a reference with a particle at each place gives its own values", "[reference]") {
  const Values x = start_positions({}, 320, period), coarse = start_positions({}, 80, period);
  Values u = smooth(x);
  u[4] += 1.0;  // an interpolating polynomial would know of its neighbors
  Values expected;
  for (std::size_t j = 0; j < coarse.size(); ++j) expected.push_back(u[4 * j]);
  CHECK(values_on_line(x, u, period, coarse) == expected);
  // 96 is no divisor, and of 80 jittered particles none stands at one of the 320.
  for (const Values& at :
       {start_positions({}, 96, period), start_positions({Start::Kind::jittered, 0.5, 1}, 80, period)}) {
    CHECK(values_on_line(x, smooth(x), period, at) == interpolate_on_line(x, smooth(x), period, at));
  }
}

TEST_CASE("the order of differences to a reference is that of the errors", "[reference]") {
  for (const double ratio : {2.0, 1.5}) {
    for (const double D : {0.0, 0.4}) {
      CAPTURE(ratio, D);
      // As if theory were right; the differences themselves have an order of 1.1 and more.
      const Differences right = differences(1.0, D, ratio, 5, 1);
      const Judgement j = judge_errors(right.levels, right.reference, 1.0, {});
      CHECK(meets(j.verdict, Verdict::confirmed));
      CHECK_THAT(j.order, WithinAbs(1.0, 0.005));
      CHECK(judge(right.levels, 1.0, {}).pairwise.back() > 1.3);
    }
  }
  // Where theory is wrong, the order is that which the errors show and not one drawn toward theory's.
  for (const double p : {0.5, 1.5, 2.0}) {
    CAPTURE(p);
    const Differences wrong = differences(p, 0.1, 2.0, 5, 2);
    const Judgement j = judge_errors(wrong.levels, wrong.reference, 1.0, {});
    CHECK(j.verdict == (p < 1.0 ? Verdict::below : Verdict::above));
    CHECK_THAT(j.order, WithinAbs(p, 0.01));
  }
  const Differences none = differences(1.0, 0.3, 2.0, 5, 1);
  CHECK(judge_errors(none.levels, std::nullopt, 1.0, {}).reason == judge(none.levels, 1.0, {}).reason);
}

TEST_CASE("orders with and without a reference agree where the solution is known", "[reference]") {
  for (const char* const delta : {"\"4*h\"", "\"h^2\""}) {
    for (const char* const scheme : {"model = 1\nkernel = \"inverse\"", "model = 2\nkernel = \"cubic-spline\""}) {
      CAPTURE(delta, scheme);
      const std::string path = std::string("delta = ") + delta + "\nN = [80, 160, 320, 640]\n";
      const Study known = study_of(solved, path, scheme),
                  unknown = study_of(unsolved, path + "reference = 1280\n", scheme);
      const auto exact = run(known.series[0]);
      auto against = run(unknown.series[0]);
      for (std::size_t i = 0; i < exact.size(); ++i) {
        // The same run: its source is the same function, its start and horizon are the same.
        CHECK(distance(exact[i].u, against[i].u) < 1e-12);
        CHECK(std::isnan(against[i].error_linf));
      }
      compare_with_reference(unknown.series[0], against);
      const Judgement with = judged(known.series[0], exact), without = judged(unknown.series[0], against);
      CHECK_THAT(without.order, WithinAbs(with.order, 0.02));
      CHECK(meets(without.verdict, Verdict::confirmed));
      // And so does the size of the errors: to the reference half of the finest is missing.
      CHECK_THAT(against[3].error_linf, WithinRel(0.5 * exact[3].error_linf, 0.1));
    }
  }
}

TEST_CASE("a reference on other particles is as good as one on the same", "[reference]") {
  const std::string path = "delta = \"4*h\"\nN = [80, 160]\n";
  const Study same = study_of(unsolved, path + "reference = 1280\n"),
              other = study_of(unsolved, path + "reference = 1279\n");
  auto on_same = run(same.series[0]), on_other = run(other.series[0]);
  compare_with_reference(same.series[0], on_same);
  compare_with_reference(other.series[0], on_other);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(on_same[i].u == on_other[i].u);
    CHECK_THAT(on_other[i].error_linf, WithinRel(on_same[i].error_linf, 1e-3));
    CHECK_THAT(on_other[i].error_l1, WithinRel(on_same[i].error_l1, 1e-3));
  }
}

TEST_CASE("errors are NaN where one of the two runs has no end", "[reference]") {
  const Study study = study_of(unsolved, "delta = \"h^2\"\nN = [20, 40, 80]\n");
  const Series& series = study.series[0];
  REQUIRE(series.levels() == 2);
  auto results = run(series);
  results[1].blow_up = "on purpose";
  compare_with_reference(series, results);
  CHECK(std::isfinite(results[0].error_linf));
  CHECK(std::isnan(results[1].error_linf));
  results[2].failure = "on purpose";
  compare_with_reference(series, results);
  CHECK(std::isnan(results[0].error_linf));
  CHECK(results[0].u_exact.empty());
}

TEST_CASE("the readable and the vector form take initial values and source that are given", "[reference]") {
  const std::string bare =
      "period = \"2*pi\"\nT = 1\nc = \"1 + sin(x)/2\"\nreference = \"finest\"\nu0 = \"exp(sin(x))\"\n";
  for (const std::string& scene :
       {bare, bare + "f = \"cos(x) * t\"\n", bare + "b = \"sin(x)/2\"\nf = \"abs(sin(x)) * t\"\n"}) {
    for (const char* const scheme : {"model = 1\nkernel = \"inverse\"", "model = 2\nkernel = \"cubic-spline\""}) {
      CAPTURE(scene, scheme);
      Case c = study_of(scene, "delta = \"4*h\"\nN = [64, 128]\n", scheme).series[0].cases[0];
      const CaseResult vector = run(c);
      c.readable = true;
      const CaseResult readable = run(c);
      CHECK(vector.blow_up.empty());
      CHECK(distance(vector.u, readable.u) < 1e-12);
      CHECK(vector.u_exact.empty());
      CHECK(vector.quadrature_points + readable.quadrature_points == 0);
    }
  }
}

TEST_CASE("a case knows its initial values and its source", "[reference]") {
  const auto key = [](const std::string& scene) {
    return study_of(scene, "delta = 1\nN = [20, 40]\n").series[0].cases[0].key();
  };
  const std::string bare = fields + "reference = \"finest\"\n";
  const std::string plain = key(bare + "u0 = \"cos(x)\"\n");
  CHECK(key(bare + "u0 = \"cos(x)\"\nf = \"0\"\n") == plain);
  CHECK(key(bare + "u0 = \"sin(x)\"\n") != plain);
  CHECK(key(bare + "u0 = \"cos(x)\"\nf = \"cos(x)\"\n") != plain);
}

TEST_CASE("at a fixed horizon a reference is of the nonlocal model, and errors against it vanish", "[reference]") {
  const auto theory = [](const std::string& scene, const std::string& delta) {
    return study_of(scene, "delta = " + delta + "\nN = [40, 80, 160]\n").series[0].theory;
  };
  CHECK(theory(solved, "0.4").order == 0.0);
  CHECK(theory(unsolved, "0.4").order == 1.0);
  CHECK(theory(unsolved, "0.4").variable == "h");
  CHECK(theory(unsolved, "0.4").statement == "Theorem 2.7 (1)");
  CHECK(theory(unsolved, "\"4*h\"").variable == "max(h,delta)");
}

TEST_CASE("the size of a solution that is not known is bounded by what is given", "[reference]") {
  const auto size = [](const std::string& given, double t) {
    const Study study = study_of("period = \"2*pi\"\nT = 2\nc = \"sin(x)\"\nreference = \"finest\"\n" + given,
                                 "delta = 1\nN = [20, 40]\n");
    return study.scene->solution_size(Values{0.0}, t);
  };
  CHECK_THAT(size("u0 = \"3*cos(x)\"\n", 0.0), WithinRel(3.0, 1e-3));
  CHECK_THAT(size("u0 = \"0\"\nf = \"5\"\n", 0.5), WithinRel(2.5 * std::exp(0.5), 1e-3));
  CHECK(size("u0 = \"0\"\n", 1.0) == 0.0);
  // A run whose solution is zero at first is not given up when its source makes it grow.
  const std::string grows = "period = \"2*pi\"\nT = 2\nc = \"1\"\nreference = \"finest\"\nu0 = \"0\"\nf = \"1e9\"\n";
  const CaseResult result = run(study_of(grows, "delta = 1\nN = [20, 40]\n").series[0].cases[0]);
  CHECK(result.blow_up.empty());
  CHECK_THAT(max_norm(result.u), WithinRel(2e9, 1e-9));
}

}  // namespace acstudy
