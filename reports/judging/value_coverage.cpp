#include "reports/judging/value_coverage.hpp"

#include <cmath>
#include <random>

#include "reports/judging/random.hpp"

namespace acstudy {

namespace {

struct Known {
  std::vector<Value> values;
  double order, limit;
};

Known draw(std::mt19937_64& generator, std::size_t n, bool two_terms) {
  constexpr double orders[] = {0.5, 1.0, 2.0, 3.0}, exponents[] = {0.5, 1.0, 2.0};
  const double order = orders[generator() % 4], q = exponents[generator() % 3];
  const double D = two_terms ? -0.6 + 1.6 * uniform(generator) : 0.0;
  const double noise = 0.001 * std::pow(30.0, uniform(generator));
  const double limit = 3.0 * normal(generator), C = generator() % 2 == 0 ? 1.0 : -1.0;
  Known known{{}, order, limit};
  double v = 1.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double error = C * std::pow(v, order) * (1.0 + D * std::pow(v, q)) * std::exp(noise * normal(generator));
    known.values.push_back({v, limit + error});
    v /= 1.4 + uniform(generator);
  }
  return known;
}

}  // namespace

std::vector<ValueCoverageRow> value_coverage(std::size_t trials, std::uint64_t seed, const ValueLawOf& law) {
  std::mt19937_64 generator(seed);
  std::vector<ValueCoverageRow> rows;
  for (const bool two_terms : {false, true}) {
    for (std::size_t n = two_terms ? 5 : 4; n <= 8; ++n) {
      ValueCoverageRow row{two_terms ? "two terms" : "power law", n, trials};
      for (std::size_t trial = 0; trial < trials; ++trial) {
        const Known known = draw(generator, n, two_terms);
        const ValueLaw fitted = law(known.values);
        if (fitted.contains(known.order)) ++row.order_covered;
        if (fitted.value_low <= known.limit && known.limit <= fitted.value_high) ++row.limit_covered;
      }
      rows.push_back(row);
    }
  }
  return rows;
}

std::vector<ValueCoverageRow> value_coverage(std::size_t trials, std::uint64_t seed) {
  return value_coverage(trials, seed, reported_value_law);
}

}  // namespace acstudy
