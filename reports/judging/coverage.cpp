#include "reports/judging/coverage.hpp"

#include <cmath>
#include <random>

#include "reports/judging/orders.hpp"
#include "reports/judging/random.hpp"

namespace acstudy {

namespace {

struct Known {
  std::vector<Level> levels;
  double order;
};

Known draw(std::mt19937_64& generator, std::size_t n, bool two_terms, double q) {
  constexpr double orders[] = {0.5, 1.0, 2.0, 3.0};
  const double order = orders[generator() % 4];
  const double D = two_terms ? -0.6 + 1.6 * uniform(generator) : 0.0;
  const double noise = 0.001 * std::pow(30.0, uniform(generator));
  Known known{{}, order};
  double v = 1.0;
  for (std::size_t i = 0; i < n; ++i) {
    known.levels.push_back({v, std::pow(v, order) * (1.0 + D * std::pow(v, q)) * std::exp(noise * normal(generator))});
    v /= 1.4 + uniform(generator);
  }
  return known;
}

}  // namespace

std::vector<CoverageRow> interval_coverage(std::size_t trials, std::uint64_t seed, const IntervalOf& interval, double q,
                                           std::string_view only) {
  std::mt19937_64 generator(seed);
  std::vector<CoverageRow> rows;
  for (const bool two_terms : {false, true}) {
    for (std::size_t n = 4; n <= 8; ++n) {
      CoverageRow row{two_terms ? "two terms" : "power law", n, trials, 0, 0.0};
      const bool wanted = only.empty() || row.series == only;
      for (std::size_t trial = 0; trial < trials; ++trial) {
        const Known known = draw(generator, n, two_terms, q);
        if (!wanted) continue;
        const Estimate estimate = interval(known.levels);
        if (estimate.contains(known.order)) ++row.covered;
        row.mean_width += (estimate.high - estimate.low) / static_cast<double>(trials);
      }
      if (wanted) rows.push_back(row);
    }
  }
  return rows;
}

std::vector<CoverageRow> interval_coverage(std::size_t trials, std::uint64_t seed, double q, std::string_view only) {
  return interval_coverage(
      trials, seed, [](LevelView levels) -> Estimate { return judge(levels, not_estimated); }, q, only);
}

}  // namespace acstudy
