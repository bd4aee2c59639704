#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

#include "solver/line/far/box_tables.hpp"
#include "solver/line/far/exponential_sum.hpp"
#include "solver/line/far/far_sweeps.hpp"
#include "tests/catch.hpp"
#include "tests/far_harness.hpp"

using namespace acstudy;
using namespace acstudy::test;

namespace {

constexpr double period = 2.0 * std::numbers::pi;

/// A sweep of the far form on all particles, ranges cut at `cuts`. @return pairs
template <class Run>
std::int64_t far_sweep(const SweptParticles& swept, std::vector<std::ptrdiff_t> cuts, Run run) {
  far::Memory memory;
  cuts.insert(cuts.begin(), 0);
  cuts.push_back(swept.range.end);
  SweepRange range = swept.range;
  std::int64_t pairs = 0;
  // Every other range first, so that one writes what belongs to another before as well as after it.
  for (const std::size_t parity : {1, 0}) {
    for (std::size_t i = parity; i + 1 < cuts.size(); i += 2) {
      range.begin = cuts[i];
      range.end = cuts[i + 1];
      pairs += run(range, memory);
    }
  }
  return pairs;
}

/// The rates, having seen that none was written beyond the particles.
BothRates rates_of(const SweptParticles& swept) {
  BothRates rates = swept.rates;
  for (auto* each : {&rates.local, &rates.nonlocal}) {
    CHECK(std::all_of(each->begin() + swept.range.end, each->end(), [](double rate) { return std::isnan(rate); }));
    each->resize(swept.local_u.size());
  }
  return rates;
}

BothRates far_upwind(SweptParticles& swept, SweepKernel::Form kernel, const std::vector<std::ptrdiff_t>& cuts = {}) {
  const UpwindSweep sweep = swept.upwind(kernel);
  const std::int64_t pairs = far_sweep(swept, cuts, [&](const SweepRange& range, far::Memory& memory) {
    return far::far_sweeps().upwind(range, sweep, memory);
  });
  std::int64_t seen = 0;
  for (std::size_t j = 0; j < swept.local_u.size(); ++j) {
    const auto& windows = swept.particles.windows;
    seen += (swept.c_hat[static_cast<std::ptrdiff_t>(j)] > 0.0 ? windows.left : windows.right)[j];
  }
  CHECK(pairs == seen);
  return rates_of(swept);
}

constexpr double mu = 2.5;

BothRates far_symmetric(SweptParticles& swept, int modes, const std::vector<std::ptrdiff_t>& cuts = {}) {
  const SymmetricSweep sweep = swept.symmetric(mu, modes);
  const std::int64_t pairs = far_sweep(swept, cuts, [&](const SweepRange& range, far::Memory& memory) {
    return far::far_sweeps().symmetric(range, sweep, memory);
  });
  const auto& [left, right, widest] = swept.particles.windows;
  CHECK(pairs == std::reduce(left.begin(), left.end()) + std::reduce(right.begin(), right.end()));
  return rates_of(swept);
}

void check_close(const BothRates& rates, const BothRates& expected, double tolerance) {
  CHECK(relative_gap(rates.local, expected.local) <= tolerance);
  CHECK(relative_gap(rates.nonlocal, expected.nonlocal) <= tolerance);
}

/// All far sweeps against the readable form.
void check_far_sweeps(SweptParticles& swept) {
  using Form = SweepKernel::Form;
  check_close(far_upwind(swept, Form::inverse), readable_upwind(swept, InverseKernel{}), 1e-12);
  check_close(far_upwind(swept, Form::cubic_spline), readable_upwind(swept, CubicSplineKernel{}), 1e-12);
  const BothRates expected = readable_symmetric(swept, mu);
  for (const int modes : {2, 3}) check_close(far_symmetric(swept, modes), expected, 1e-12);
}

}  // namespace

TEST_CASE("The reciprocal is a sum of exponentials to round-off, by rates that a window forgets", "[far]") {
  for (int log2_ratio = 1; log2_ratio <= far::max_log2_ratio; ++log2_ratio) {
    const far::ExponentialSum& sum = far::reciprocal_sum(log2_ratio);
    CAPTURE(log2_ratio, sum.count);
    const double ratio = std::ldexp(1.0, log2_ratio);
    double largest = 0.0;
    for (int i = 0; i <= 5000; ++i) {
      const double s = std::pow(ratio, i / 5000.0);
      long double value = 0.0L;
      for (int m = 0; m < sum.count; ++m) value += sum.weight[m] * std::exp(-static_cast<long double>(s) * sum.rate[m]);
      largest = std::max(largest, static_cast<double>(std::abs(s * value - 1.0L)));
    }
    CHECK(largest <= 4e-15);
    for (int m = 0; m < sum.count; ++m) {
      CHECK(sum.rate[m] * ratio >= 0.099);
      // No digits are lost between terms of different signs.
      CHECK(std::abs(sum.weight[m]) <= 10.0 * sum.rate[m]);
    }
    CHECK(far::reciprocal_sum(log2_ratio, sum.count / 2).error > 1e-12);
  }
  CHECK_THROWS_AS(far::reciprocal_sum(0), std::invalid_argument);
  CHECK_THROWS_AS(far::reciprocal_sum(far::max_log2_ratio + 1), std::invalid_argument);
}

TEST_CASE("Boxes that are one box apart see each other's particles to round-off, and with fewer terms do not",
          "[far]") {
  // Relative error of 1/s between any two points of boxes with `first` to `last` boxes between them.
  const auto error = [](const auto& e, int first, int last, int terms, double lowest = -1.0) {
    double largest = 0.0;
    for (int between = first; between <= last; ++between) {
      for (double tau = lowest; tau <= 1.0; tau += 0.125) {
        for (double t = -1.0; t <= 1.0; t += 0.125) {
          const double s = between + 0.5 * (1.0 - tau) + 0.5 * (1.0 + t);
          long double value = 0.0L;
          for (int m = 0; m < e.count; ++m) {
            long double in = 0.0L, out = 0.0L;
            for (int n = terms - 1; n >= 0; --n) {
              in = in * tau + e.in[n][m];
              out = out * t + e.out[m][n];
            }
            value += in * out * std::exp(-static_cast<long double>(e.rate[m]) * between);
          }
          largest = std::max(largest, static_cast<double>(std::abs(s * value - 1.0L)));
        }
      }
    }
    return largest;
  };
  constexpr double per_box = 16.0;
  CHECK(far::box_tables<true>(7.9 * per_box, per_box) == nullptr);
  for (const int boxes : {8, 24, 256}) {
    CAPTURE(boxes);
    using OnePiece = far::BoxTables<false>;
    using TwoPieces = far::BoxTables<true>;
    const OnePiece* const one = far::box_tables<false>(boxes * per_box, per_box);
    const TwoPieces* const two = far::box_tables<true>(boxes * per_box, per_box);
    REQUIRE((one != nullptr && two != nullptr));
    REQUIRE((one->boxes == boxes && two->boxes == boxes));
    CHECK(error(one->inner, 1, boxes - 2, OnePiece::inner_terms) <= 5e-15);
    CHECK(error(one->inner, 1, boxes - 2, OnePiece::inner_terms - 4) > 1e-12);
    CHECK(error(two->inner, 1, boxes / 2 - 2, TwoPieces::inner_terms) <= 5e-12);
    CHECK(error(two->inner, 2, boxes / 2 - 2, TwoPieces::inner_terms) <= 1e-14);
    CHECK(error(two->outer, boxes / 2, boxes - 2, TwoPieces::outer_terms) <= 5e-15);
    // A particle whose cell ends in the box may stand a little further out.
    CHECK(error(two->outer, boxes / 2, boxes - 2, TwoPieces::outer_terms, -1.2) <= 5e-14);
    if (boxes == 8) CHECK(error(two->outer, boxes / 2, boxes - 2, TwoPieces::outer_terms - 6) > 1e-12);
  }
}

TEST_CASE("The far form has the readable form's rates and pairs", "[far]") {
  struct Sample {
    std::size_t N;
    double neighbors, spread;
  };
  unsigned seed = 0;
  for (const auto& [N, neighbors, spread] :
       {Sample{5, 1.7, 5.0}, Sample{97, 0.3, 5.0}, Sample{97, 40.0, 5.0}, Sample{603, 290.0, 5.0},
        Sample{703, 310.0, 1000.0}, Sample{1201, 300.0, 1.01}, Sample{1603, 790.0, 50.0}, Sample{5400, 2600.0, 5.0}}) {
    for (const double shift : {0.0, 2.1}) {
      CAPTURE(N, neighbors, spread, shift);
      seed += 3;
      const double delta = neighbors * period / static_cast<double>(N);
      SweptParticles swept(irregular_positions(N, period, seed, spread), period, delta,
                           translated(uneven_velocity(), shift), seed + 1);
      check_far_sweeps(swept);
    }
  }
}

TEST_CASE("The far form has the readable form's rates on clusters with gaps beyond the horizon between them", "[far]") {
  std::mt19937 generator(11);
  for (int sample = 0; sample < 6; ++sample) {
    // Clusters of 1 to 300 particles, in gaps over three orders of magnitude.
    std::vector<double> x{0.0};
    for (int cluster = 0; cluster < 12; ++cluster) {
      const int size = cluster % 4 == 3 ? 1 : std::uniform_int_distribution(20, 300)(generator);
      const double gap = std::pow(10.0, std::uniform_real_distribution(-5.0, -3.0)(generator));
      for (int i = 0; i < size; ++i) x.push_back(x.back() + gap * (1.0 + 0.3 * (i % 3)));
      x.push_back(x.back() + std::pow(10.0, std::uniform_real_distribution(-3.0, 0.0)(generator)));
    }
    const double scale = period / (x.back() + 0.05);
    for (double& position : x) position *= scale;
    for (const double delta : {0.03, 0.2, 0.5, 1.1, 2.9}) {
      CAPTURE(sample, delta);
      SweptParticles swept(x, period, delta, uneven_velocity(), 31);
      check_far_sweeps(swept);
    }
  }
}

TEST_CASE("A gap of many horizons leaves nothing behind in the far form", "[far]") {
  // Two clusters of three horizons with 200 neighbors on a side, 50 horizons apart.
  constexpr double delta = 0.1;
  std::vector<double> x;
  for (int i = 0; i < 600; ++i) x.push_back(3.0 * delta * i / 600);
  for (int i = 0; i < 600; ++i) x.push_back(53.0 * delta + 3.0 * delta * i / 600);
  SweptParticles swept(x, period, delta, constant_velocity(1.0), 17);
  check_far_sweeps(swept);
}

TEST_CASE("A neighbor at the horizon counts in the far form as it does in the readable one", "[far]") {
  for (const int neighbors : {4, 64, 150, 400}) {
    CAPTURE(neighbors);
    constexpr std::size_t N = 1024;
    SweptParticles swept(uniform_positions(N, period), period, neighbors * period / N, uneven_velocity(), 5);
    check_far_sweeps(swept);
  }
}

TEST_CASE("Ranges of the far form write what is theirs, wherever they are cut", "[far]") {
  constexpr std::size_t N = 1500;
  const auto x = irregular_positions(N, period, 8);
  const auto swept = [&] { return SweptParticles(x, period, 0.18 * period, uneven_velocity(), 9); };
  for (const auto& rates : {std::function([](SweptParticles&particles, const std::vector<std::ptrdiff_t>&cuts) {
                              return far_upwind(particles, SweepKernel::Form::inverse, cuts);
                            }),
                            std::function([](SweptParticles&particles, const std::vector<std::ptrdiff_t>&cuts) {
                              return far_symmetric(particles, 2, cuts);
                            })}) {
    SweptParticles whole = swept();
    const BothRates expected = rates(whole, {});
    for (const auto& cuts : {std::vector<std::ptrdiff_t>{750}, {1, 2, 40, 1499}, {333, 341, 1100}}) {
      SweptParticles cut = swept();
      const BothRates its = rates(cut, cuts), again = rates(cut, cuts);
      check_close(its, expected, 1e-13);
      CHECK(its.local == again.local);
      CHECK(its.nonlocal == again.nonlocal);
    }
  }
}
