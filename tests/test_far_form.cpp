#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "solver/far/exponential_sum.hpp"
#include "solver/far/far_sweeps.hpp"
#include "solver/far/moving_moments.hpp"
#include "tests/catch.hpp"
#include "tests/far_harness.hpp"

using namespace acstudy;
using namespace acstudy::test;

namespace {

constexpr double period = 2.0 * std::numbers::pi;

/// Rates of Model I with the inverse kernel, ranges cut at `cuts`.
BothRates far_upwind(SweptParticles& swept, std::vector<std::ptrdiff_t> cuts = {}) {
  far::Memory memory;
  const UpwindSweep sweep = swept.upwind(SweepKernel::Form::inverse);
  cuts.push_back(swept.range.end);
  SweepRange range = swept.range;
  std::int64_t pairs = 0, seen = 0;
  for (const std::ptrdiff_t cut : cuts) {
    range.end = cut;
    pairs += far::far_sweeps().upwind(range, sweep, memory);
    range.begin = cut;
  }
  for (std::size_t j = 0; j < swept.local_u.size(); ++j) {
    const auto& windows = swept.particles.windows;
    seen += (swept.c_hat[static_cast<std::ptrdiff_t>(j)] > 0.0 ? windows.left : windows.right)[j];
  }
  CHECK(pairs == seen);
  BothRates rates = swept.rates;
  for (auto* each : {&rates.local, &rates.nonlocal}) {
    CHECK(std::all_of(each->begin() + swept.range.end, each->end(), [](double rate) { return std::isnan(rate); }));
    each->resize(swept.local_u.size());
  }
  return rates;
}

/// max_j |sum_i q_i/(x_j - x_i)| of the moments beside the same in long double, relative to the sum of positive
/// charges, where charges are at a distance from `nearest` up to a window of `neighbors` of them.
double moments_error(const far::ExponentialSum& sum, int neighbors) {
  const int count = 4 * neighbors / far::panel_size * far::panel_size;
  const double nearest = neighbors / sum.ratio;
  const std::vector<double> q = irregular_values(static_cast<std::size_t>(count), 3);
  std::vector<double> x(q.size());
  for (int i = 0; i < count; ++i) x[i] = i + 0.3 * q[(i * 7) % count];
  far::Scratch scratch;
  const std::ptrdiff_t panels = neighbors / far::panel_size + 2;
  far::MovingMoments<2> moments(sum, nearest, panels, scratch.reserve(far::MovingMoments<2>::memory(panels, sum)));
  int front = 0, back = 0;
  double largest = 0.0;
  for (int j = 0; j < count; j += far::panel_size) {
    for (; front + far::panel_size <= j && x[j] - x[front + far::panel_size - 1] >= nearest; front += far::panel_size) {
      double charge[2 * far::panel_size];
      for (int i = 0; i < far::panel_size; ++i) {
        charge[i] = 1.0;
        charge[far::panel_size + i] = q[front + i];
      }
      moments.push(x.data() + front, charge);
    }
    for (; back < front && x[j] - x[back] > neighbors; back += far::panel_size) moments.pop();
    if (moments.empty()) continue;
    Lanes sums[2] = {};
    moments.add(x[j], spread(x[j]), sums);
    long double direct[2] = {};
    for (int i = back; i < front; ++i) {
      direct[0] += 1.0L / (static_cast<long double>(x[j]) - x[i]);
      direct[1] += q[i] / (static_cast<long double>(x[j]) - x[i]);
    }
    for (int c : {0, 1}) {
      largest = std::max(largest, static_cast<double>(std::abs(sums[c][0] - direct[c]) / direct[0]));
    }
  }
  return largest;
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

TEST_CASE("Moving moments sum charges over distance, and a shorter sum of exponentials does not", "[far]") {
  for (const int log2_ratio : {1, 3, 6, 8}) {
    CAPTURE(log2_ratio);
    const far::ExponentialSum& sum = far::reciprocal_sum(log2_ratio);
    const int neighbors = 40 << log2_ratio;
    CHECK(moments_error(sum, neighbors) <= 2e-14);
    CHECK(moments_error(far::reciprocal_sum(log2_ratio, sum.count / 2), neighbors) > 1e-12);
  }
}

TEST_CASE("The far form of Model I has the readable form's rates", "[far]") {
  struct Sample {
    std::size_t N;
    double neighbors, spread;
  };
  unsigned seed = 0;
  for (const auto& [N, neighbors, spread] :
       {Sample{5, 1.7, 5.0}, Sample{97, 0.3, 5.0}, Sample{97, 40.0, 5.0}, Sample{400, 90.0, 5.0},
        Sample{403, 190.0, 1000.0}, Sample{1201, 300.0, 1.01}, Sample{1603, 790.0, 50.0}, Sample{5400, 2600.0, 5.0}}) {
    for (const double shift : {0.0, 2.1}) {
      CAPTURE(N, neighbors, spread, shift);
      seed += 3;
      const double delta = neighbors * period / static_cast<double>(N);
      SweptParticles swept(irregular_positions(N, period, seed, spread), period, delta,
                           translated(uneven_velocity(), shift), seed + 1);
      const BothRates far = far_upwind(swept), readable = readable_upwind(swept, InverseKernel{});
      CHECK(relative_gap(far.local, readable.local) <= 1e-12);
      CHECK(relative_gap(far.nonlocal, readable.nonlocal) <= 1e-12);
    }
  }
}

TEST_CASE("A neighbor at the horizon counts in the far form as it does in the readable one", "[far]") {
  for (const int neighbors : {4, 64, 150, 400}) {
    CAPTURE(neighbors);
    constexpr std::size_t N = 1024;
    SweptParticles swept(uniform_positions(N, period), period, neighbors * period / N, uneven_velocity(), 5);
    const BothRates far = far_upwind(swept), readable = readable_upwind(swept, InverseKernel{});
    CHECK(relative_gap(far.local, readable.local) <= 1e-12);
    CHECK(relative_gap(far.nonlocal, readable.nonlocal) <= 1e-12);
  }
}

TEST_CASE("Ranges of the far form write what is theirs, wherever they are cut", "[far]") {
  constexpr std::size_t N = 1500;
  const auto x = irregular_positions(N, period, 8);
  SweptParticles whole(x, period, 0.13 * period, uneven_velocity(), 9);
  const BothRates expected = far_upwind(whole);
  for (const auto& cuts : {std::vector<std::ptrdiff_t>{750}, {1, 2, 40, 1499}, {333, 341, 1100}}) {
    SweptParticles cut(x, period, 0.13 * period, uneven_velocity(), 9);
    const BothRates rates = far_upwind(cut, cuts), again = far_upwind(cut, cuts);
    CHECK(relative_gap(rates.local, expected.local) <= 1e-13);
    CHECK(relative_gap(rates.nonlocal, expected.nonlocal) <= 1e-13);
    CHECK(rates.local == again.local);
  }
}
