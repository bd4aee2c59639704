#include <gsl/gsl_fit.h>

#include <cmath>
#include <random>
#include <vector>

#include "reports/judging/orders.hpp"
#include "tests/catch.hpp"

using namespace acstudy;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

const std::vector<double> uneven = {0.4, 0.29, 0.17, 0.08, 0.051, 0.022};

template <class Error>
std::vector<Level> levels(Error error, std::size_t n = uneven.size()) {
  std::vector<Level> all;
  for (std::size_t i = 0; i < n; ++i) all.push_back({uneven[i], error(uneven[i])});
  return all;
}

}  // namespace

TEST_CASE("a line is GSL's to the last bit") {
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> uniform(-3.0, 3.0);
  for (std::size_t n = 3; n <= 9; ++n) {
    for (int trial = 0; trial < 50; ++trial) {
      std::vector<double> x(n), weight(n), y(n);
      for (std::size_t i = 0; i < n; ++i) {
        x[i] = uniform(generator);
        weight[i] = trial % 5 == 0 ? 1.0 : trial % 7 == 0 && i == 1 ? 0.0 : std::exp(uniform(generator));
        y[i] = 2.0 * x[i] + uniform(generator);
      }
      const FittedLine line = WeightedLines(x, weight).through(y);
      double intercept, slope, cov00, cov01, cov11, residual;
      gsl_fit_wlinear(x.data(), 1, weight.data(), 1, y.data(), 1, n, &intercept, &slope, &cov00, &cov01, &cov11,
                      &residual);
      CHECK(line.intercept == intercept);
      CHECK(line.slope == slope);
      CHECK(line.slope_variance == cov11);
      CHECK(line.residual == residual);
    }
  }
}

TEST_CASE("a corrected law finds its own parameters") {
  for (const double D : {-1.5, 0.7, 2.0}) {
    const CorrectedLaw law =
        fit_corrected_law(levels([D](double v) { return 0.3 * std::pow(v, 1.5) * (1 + D * v); }, 4));
    CAPTURE(D);
    CHECK_THAT(law.order, WithinAbs(1.5, 1e-5));
    CHECK_THAT(law.C, WithinRel(0.3, 1e-4));
    CHECK_THAT(law.D, WithinRel(D, 1e-4));
    CHECK(law.q == 1.0);
    CHECK_THAT(law.at(0.1), WithinRel(0.3 * std::pow(0.1, 1.5) * (1 + 0.1 * D), 1e-6));
  }
  const auto quadratic = levels([](double v) { return 0.3 * v * (1 + 3 * v * v); });
  const CorrectedLaw law = fit_corrected_law(quadratic);
  CHECK_THAT(law.order, WithinAbs(1.0, 1e-4));
  CHECK_THAT(law.q, WithinAbs(2.0, 1e-2));
  CHECK(std::abs(fit_corrected_law_only(quadratic, 1.0).order - 1.0) > 1e-3);
  CHECK_THAT(fit_correction_of(quadratic, 1.0).q, WithinAbs(2.0, 1e-2));
}

TEST_CASE("the corrected law's interval contains its order and grows with the probability that is asked for") {
  auto data = levels([](double v) { return v * (1 - v); }, 5);
  data[1].error *= 1.01;
  data[3].error *= 0.99;
  const CorrectedLaw law = fit_corrected_law(data);
  const double t = student(0.95, 2);
  CHECK_THAT(t, WithinAbs(4.302653, 1e-6));
  CHECK(law.low < law.order);
  CHECK(law.order < law.high);
  CHECK(fit_corrected_law(data, 0.01).low < law.low);
  CHECK(fit_corrected_law(data, 0.01).high > law.high);
}

TEST_CASE("a law with a floor finds the floor") {
  const FlooredLaw law = fit_floored_law(levels([](double v) { return 2.0 * v * v + 0.03; }));
  CHECK_THAT(law.order, WithinAbs(2.0, 1e-4));
  CHECK_THAT(law.F, WithinRel(0.03, 1e-4));
  CHECK(law.contains(2.0));
  CHECK_THAT(fit_floored_law(levels([](double v) { return v; })).F, WithinAbs(0.0, 1e-6));
}

TEST_CASE("a level counts by its weight") {
  auto data = levels([](double v) { return v; });
  data[2].error *= 1.5;
  CHECK(std::abs(fit_power_law(data).order - 1.0) > 1e-3);
  data[2].weight = 1e-9;
  CHECK_THAT(fit_power_law(data).order, WithinAbs(1.0, 1e-8));
  CHECK_THAT(fit_corrected_law(data).order, WithinAbs(1.0, 1e-4));
  CHECK_THAT(fit_floored_law(data).order, WithinAbs(1.0, 1e-4));
  // Only ratios of weights matter.
  auto doubled = data;
  for (Level& level : doubled) level.weight *= 2.0;
  CHECK_THAT(judge(doubled, 1.0).high, WithinAbs(judge(data, 1.0).high, 1e-6));
}

TEST_CASE("too few levels for a model are no estimate") {
  const auto three = levels([](double v) { return v; }, 3);
  CHECK(std::isfinite(fit_power_law(three).order));
  CHECK(std::isnan(fit_corrected_law(three).order));
  CHECK(std::isnan(fit_floored_law(three).F));
  CHECK(std::isnan(leave_one_out(three).change));
  CHECK_FALSE(find_outlier(three).has_value());
  CHECK(std::isnan(fit_power_law(std::span(three).first(2)).order));
}

TEST_CASE("the window leaves out coarse levels that follow no law, and no others") {
  const auto from = [](std::size_t bad) {
    auto data = levels([](double v) { return v; });
    data.push_back({0.01, 0.01});
    data.push_back({0.005, 0.005});
    for (std::size_t i = 0; i < bad; ++i) data[i].error = 0.17 + 0.01 * data[i].variable;
    return data;
  };
  CHECK(asymptotic_window(from(0)).first == 0);
  CHECK(asymptotic_window(from(2)).first == 2);
  CHECK(judge(from(2), 1.0).verdict == Verdict::confirmed);
  CHECK(judge(from(2), 1.0).reason.find("levels 3 to 8") != std::string::npos);
  auto stops = from(0);
  stops[7].error = stops[6].error;
  CHECK(asymptotic_window(stops).last == 7);
  CHECK(judge(stops, 1.0).verdict == Verdict::stagnates);
}

TEST_CASE("leaving out one level tells which one the order hangs on") {
  auto data = levels([](double v) { return v; });
  data.back().error *= 1.2;
  const LeaveOneOut most = leave_one_out(data);
  CHECK(most.level == data.size() - 1);
  CHECK_THAT(most.change, WithinAbs(1.0 - fit_power_law(data).order, 1e-12));
}

TEST_CASE("without a theory's order a sharp order is determined, and nothing is confirmed") {
  const auto verdict = [](auto error) { return judge(levels(error), not_estimated).verdict; };
  CHECK(verdict([](double v) { return v; }) == Verdict::determined);
  CHECK_FALSE(meets(Verdict::determined, Verdict::confirmed));
  CHECK(verdict([](double v) { return 0.01 + 1e-3 * v; }) == Verdict::stagnates);
  CHECK(verdict([](double v) { return 1 / v; }) == Verdict::diverges);
  CHECK(verdict([](double v) { return v > 0.1 ? v : 1e-15; }) == Verdict::floor);
  CHECK(verdict([](double v) { return v * v > 0.01 ? v : 1e-3; }) == Verdict::stagnates);
  CHECK(verdict([](double v) { return v > 0.1 ? v : std::nan(""); }) == Verdict::unstable);
}
