#include <cmath>
#include <random>

#include "catch.hpp"
#include "reports/judging/random.hpp"
#include "reports/judging/value_coverage.hpp"
#include "reports/judging/values.hpp"

namespace acstudy {

using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

bool says(const ValueJudgement& judged, const std::string& words) {
  return judged.reason.find(words) != std::string::npos;
}

const std::vector<double> uneven = {0.1, 0.071, 0.043, 0.0193, 0.011, 0.0047};

template <class Law>
std::vector<Value> values_at(const std::vector<double>& variables, Law law) {
  std::vector<Value> values;
  for (const double v : variables) values.push_back({v, law(v)});
  return values;
}

std::vector<double> halved(std::size_t levels) {
  std::vector<double> variables;
  for (std::size_t i = 0; i < levels; ++i) variables.push_back(std::ldexp(0.1, -static_cast<int>(i)));
  return variables;
}

}  // namespace

TEST_CASE("exact values give exactly their order and limit, at unequal ratios") {
  for (const double p : {0.5, 1.0, 2.0, 3.5}) {
    const auto values = values_at(uneven, [p](double v) { return 3.0 - 0.7 * std::pow(v, p); });
    const ValueLaw law = fit_value_law(values);
    CHECK_THAT(law.order, WithinAbs(p, 1e-6));
    CHECK_THAT(law.value, WithinAbs(3.0, 1e-9));
    CHECK_THAT(law.C, WithinRel(-0.7, 1e-5));
    CHECK(law.contains(p));
    CHECK(law.high - law.low < 1e-4);
    const auto all = differences_of(values);
    for (std::size_t i = 1; i < all.size(); ++i) {
      CHECK_THAT(order_between(all[i - 1], all[i]).value(), WithinAbs(p, 1e-6));
    }
  }
}

TEST_CASE("a correction of the values is found, and does not enter order and limit") {
  for (const double q : {0.5, 1.0, 2.0}) {
    const auto values =
        values_at(uneven, [q](double v) { return 3.0 - 0.7 * v * (1.0 - 0.5 * std::pow(10.0 * v, q)); });
    const ValueLaw law = fit_corrected_value_law(values);
    CHECK(law.q == q);
    CHECK_THAT(law.order, WithinAbs(1.0, 1e-4));
    CHECK_THAT(law.value, WithinAbs(3.0, 1e-6));
    CHECK_THAT(law.D, WithinRel(-0.5 * std::pow(10.0, q), 1e-2));
    CHECK(std::abs(fit_value_law(values).order - 1.0) > 0.05);
  }
}

TEST_CASE("too few values for a law are no estimate") {
  const auto values = values_at(uneven, [](double v) { return v; });
  CHECK(std::isnan(fit_value_law(std::span(values).first(3)).order));
  CHECK(std::isnan(fit_corrected_value_law(std::span(values).first(4)).order));
}

TEST_CASE("differences stand for errors of the right order where the ratios are unequal") {
  // The order that the errors are made for is off, and the order between them is not.
  std::vector<Level> levels;
  for (const Difference& d : differences_of(values_at(uneven, [](double v) { return 5.0 + v * v; }))) {
    levels.push_back(level_of(d, 1.9));
    CHECK(levels.back().variable < d.variable);
    CHECK(levels.back().variable > d.finer);
  }
  CHECK_THAT(fit_power_law(levels).order, WithinAbs(2.0, 2e-3));
  const Difference one{0.1, 0.05, 0.0075};
  CHECK_THAT(level_of(one, 2.0).error, WithinRel(std::pow(level_of(one, 2.0).variable, 2.0), 1e-12));
}

TEST_CASE("values are judged as errors are") {
  const auto exact = values_at(uneven, [](double v) { return 3.0 - 0.7 * v * v; });
  CHECK(judge_values(exact, 2.0).verdict == Verdict::confirmed);
  CHECK(judge_values(exact, 1.0).verdict == Verdict::above);
  CHECK(judge_values(exact, 3.0).verdict == Verdict::below);
  CHECK(judge_values(exact, not_estimated).verdict == Verdict::determined);
  CHECK(judge_differences(differences_of(exact), 2.0).verdict == Verdict::confirmed);
  CHECK(judge_differences(differences_of(exact), 3.0).verdict == Verdict::below);
  CHECK(judge_values(values_at(halved(6), [](double v) { return std::log(v); }), 1.0).verdict == Verdict::stagnates);
  const auto corrected = values_at(halved(7), [](double v) { return 3.0 - 0.7 * v * (1.0 + 4.0 * v); });
  CHECK(meets(judge_values(corrected, 1.0).verdict, Verdict::confirmed));
}

TEST_CASE("neither units nor an offset of the values decide") {
  std::mt19937_64 generator(7);
  for (const double noise : {0.0, 0.003, 0.05}) {
    const auto plain = values_at(halved(6), [&](double v) {
      return 0.7 * std::pow(v, 2.0) * (1.0 + 3.0 * v) * std::exp(noise * normal(generator));
    });
    for (const double order : {1.0, 2.0, 2.5, not_estimated}) {
      const ValueJudgement expected = judge_values(plain, order);
      for (const double scale : {1e-200, 1e-9, -1e-3, 1.0, 1e9, 1e200}) {
        for (const double offset : {0.0, 0.01}) {
          auto scaled = plain;
          for (Value& value : scaled) value.value = scale * (value.value + offset);
          const ValueJudgement judged = judge_values(scaled, order);
          INFO("scale " << scale << ", offset " << offset << ", order " << order << ": " << judged.reason);
          CHECK(judged.verdict == expected.verdict);
          CHECK_THAT(judged.order, WithinAbs(expected.order, 1e-3));
          CHECK_THAT(judged.extrapolated / scale - offset, WithinAbs(expected.extrapolated, 1e-6));
          CHECK_THAT(judged.least_squares.uncertainty / std::abs(scale),
                     WithinRel(expected.least_squares.uncertainty, 1e-3));
        }
      }
    }
  }
}

TEST_CASE("three levels solve exactly for the order, and have no interval") {
  const ValueJudgement judged = judge_values(values_at({0.1, 0.06, 0.05}, [](double v) { return 1.0 + v * v; }), 2.0);
  CHECK(judged.verdict == Verdict::inconclusive);
  CHECK(says(judged, "three levels"));
  CHECK_THAT(judged.order, WithinAbs(2.0, 1e-9));
  CHECK_THAT(judged.extrapolated, WithinAbs(1.0, 1e-9));
  CHECK_THAT(judged.gci.uncertainty, WithinRel(1.25 * 0.0025, 1e-6));
  CHECK(std::isnan(judged.low));
  CHECK(std::isnan(judged.extrapolated_low));
  CHECK(std::isnan(judged.least_squares.uncertainty));
  CHECK(judge_values(values_at({0.1, 0.05}, [](double v) { return v; }), 1.0).verdict == Verdict::inconclusive);
}

TEST_CASE("values that swing or run away are named") {
  double sign = 1.0;
  const auto swinging = values_at(halved(6), [&](double v) { return 3.0 + (sign = -sign) * v * v; });
  const ValueJudgement swings = judge_values(swinging, 2.0);
  CHECK(swings.verdict == Verdict::inconclusive);
  CHECK(says(swings, "oscillate"));
  CHECK(says(swings, "factor of -0.25"));
  CHECK_THAT(swings.order, WithinAbs(2.0, 1e-6));
  CHECK(swings.gci.safety_factor == 3.0);

  const auto running = values_at(halved(5), [](double v) { return 1.0 / v; });
  const ValueJudgement runs = judge_values(running, 1.0);
  CHECK(runs.verdict == Verdict::diverges);
  CHECK(says(runs, "the values diverge: differences -10, -20, -40, -80"));
  CHECK(std::isnan(runs.extrapolated));
  CHECK(std::isnan(runs.gci.uncertainty));
  CHECK(judge_values(std::span(running).first(3), 1.0).verdict == Verdict::diverges);

  sign = 1.0;
  const auto both = values_at(halved(5), [&](double v) { return (sign = -sign) / v; });
  CHECK(judge_values(both, 1.0).verdict == Verdict::diverges);
  CHECK(says(judge_values(both, 1.0), "swing and diverge"));
}

TEST_CASE("coarse values before the last change of direction are left out") {
  auto values = values_at(halved(7), [](double v) { return 3.0 - 0.7 * v * v; });
  values[1].value += 0.1;
  const ValueJudgement judged = judge_values(values, 2.0);
  CHECK(judged.verdict == Verdict::confirmed);
  CHECK(judged.first >= 1);
  CHECK(says(judged, "change direction"));
  CHECK_THAT(judged.extrapolated, WithinAbs(3.0, 1e-9));
}

TEST_CASE("a difference that printed digits explain is a floor") {
  std::vector<Value> values = {{0.4, 1.16, 0.005}, {0.2, 1.04, 0.005}, {0.1, 1.01, 0.005}, {0.05, 1.01, 0.005}};
  const ValueJudgement judged = judge_values(values, 2.0);
  CHECK(judged.verdict == Verdict::floor);
  CHECK(says(judged, "digits"));
  // Ten digits more, and the same differences are what they are.
  for (Value& value : values) value.digits = 5e-13;
  values.back().value = 1.0025;
  CHECK(judge_values(values, 2.0).verdict == Verdict::confirmed);
  // The interval is at least as wide as digits allow: these fit exactly by chance.
  for (Value& value : values) value.digits = 0.002;
  const ValueLaw law = fit_value_law(values);
  CHECK(law.high - law.low > 0.1);
  CHECK(judge_values(std::vector<Value>(5, {1.0, 2.0}), 1.0).verdict == Verdict::inconclusive);
  CHECK(judge_values(values_at(halved(5), [](double) { return 2.0; }), 1.0).verdict == Verdict::floor);
}

TEST_CASE("values that are not finite, or levels that are no refinement, have their verdict") {
  const auto with = [](double variable, double value) {
    auto values = values_at(halved(5), [](double v) { return v; });
    values[2] = {variable, value};
    return judge_values(values, 1.0).verdict;
  };
  CHECK(with(0.025, std::nan("")) == Verdict::unstable);
  CHECK(with(0.025, -INFINITY) == Verdict::unstable);
  CHECK(with(0.05, 0.05) == Verdict::inconclusive);
  CHECK(with(-1.0, 0.05) == Verdict::inconclusive);
  CHECK(judge_values({}, 1.0).verdict == Verdict::inconclusive);
}

TEST_CASE("the safety factor of the grid convergence index is that of the order's reliability") {
  const Difference last{0.1, 0.05, 0.03};
  const double steady[] = {1.9, 2.0}, unsteady[] = {0.9, 2.0};
  const auto factor = [&](double observed, std::span<const double> pairs, double theory, bool monotone = true) {
    return grid_convergence_index(last, observed, pairs, theory, monotone).safety_factor;
  };
  CHECK(factor(2.0, steady, 2.0) == 1.25);
  CHECK(factor(2.0, steady, not_estimated) == 1.25);
  CHECK(factor(2.0, unsteady, not_estimated) == 3.0);
  CHECK(factor(2.0, unsteady, 2.0) == 1.25);
  CHECK(factor(1.0, steady, 2.0) == 3.0);
  CHECK(factor(2.0, steady, 2.0, false) == 3.0);
  CHECK_THAT(grid_convergence_index(last, 2.0, steady, 2.0, true).uncertainty, WithinRel(1.25 * 0.01, 1e-12));
  // An order beyond theory's is not relied upon, nor one below 1/2.
  CHECK(grid_convergence_index(last, 3.0, steady, 2.0, true).order == 2.0);
  CHECK(grid_convergence_index(last, 0.1, steady, 2.0, true).order == 0.5);
  CHECK(std::isnan(factor(-1.0, steady, 2.0)));
}

TEST_CASE("the least-squares uncertainty chooses its expansion by order and standard deviation") {
  const auto of = [](auto law) { return least_squares_uncertainty(values_at(halved(5), law)); };
  const double finest = 0.1 / 16;
  const LeastSquaresUncertainty regular = of([](double v) { return 1.0 + std::pow(v, 1.5); });
  CHECK(regular.expansion == "h^p");
  CHECK_THAT(regular.order, WithinAbs(1.5, 1e-5));
  CHECK_THAT(regular.value, WithinAbs(1.0, 1e-7));
  CHECK(regular.safety_factor == 1.25);
  CHECK_THAT(regular.uncertainty, WithinRel(1.25 * std::pow(finest, 1.5), 1e-3));
  const LeastSquaresUncertainty fast = of([](double v) { return 1.0 + 100.0 * std::pow(v, 4.0); });
  CHECK(fast.expansion == "h^2");
  CHECK(fast.safety_factor == 3.0);
  CHECK_THAT(fast.order, WithinAbs(4.0, 1e-3));
  const LeastSquaresUncertainty slow = of([](double v) { return 1.0 + std::pow(v, 0.2); });
  CHECK(slow.expansion == "h and h^2");
  CHECK(slow.safety_factor == 3.0);
  // Scatter beyond the data range parameter: the uncertainty grows with it, and no order is believed.
  const LeastSquaresUncertainty wild =
      least_squares_uncertainty(std::vector<Value>{{0.8, 1.0}, {0.4, 2.0}, {0.2, 1.0}, {0.1, 2.0}, {0.05, 1.0}});
  CHECK_THAT(wild.range, WithinRel(0.25, 1e-12));
  CHECK(wild.deviation > wild.range);
  CHECK(wild.safety_factor == 3.0);
  CHECK(wild.uncertainty > 3.0 * wild.deviation * wild.deviation / wild.range);
  CHECK(std::isnan(least_squares_uncertainty(values_at(halved(3), [](double v) { return v; })).uncertainty));
}

TEST_CASE("the interval of order and limit contains them 95 times in 100") {
  std::size_t order = 0, limit = 0, plain_order = 0, trials = 0;
  for (const ValueCoverageRow& row : value_coverage(150, 3)) {
    trials += row.trials;
    order += row.order_covered;
    limit += row.limit_covered;
  }
  const auto share = [&](std::size_t covered) { return static_cast<double>(covered) / static_cast<double>(trials); };
  CHECK(share(order) > 0.93);
  CHECK(share(order) < 0.97);
  CHECK(share(limit) > 0.93);
  CHECK(share(limit) < 0.97);
  // Negative control: an interval that takes no correction into account misses most orders that have one.
  trials = 0;
  for (const ValueCoverageRow& row : value_coverage(150, 3, fit_value_law)) {
    if (row.series != "two terms") continue;
    trials += row.trials;
    plain_order += row.order_covered;
  }
  CHECK(share(plain_order) < 0.5);
}

}  // namespace acstudy
