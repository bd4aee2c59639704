#include "mms/trigonometric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mms/vector_math.hpp"
#include "solver/vector/sweeps.hpp"

namespace acstudy {

namespace {

constexpr std::size_t block_size = 256;
using Block = std::array<double, block_size>;

/// @pre n is a multiple of vector_width, so that every element takes the same path
ACSTUDY_VECTOR_CLONES void sweep_phases(Block& cosine, Block& sine, std::size_t n) {
  // cosine holds w x/2 at first
  for (std::size_t i = 0; i < n; ++i) sine[i] = std::sin(cosine[i]);
  for (std::size_t i = 0; i < n; ++i) cosine[i] = std::cos(cosine[i]);
}

constexpr std::size_t whole_vectors(std::size_t n) { return (n + vector_width - 1) / vector_width * vector_width; }

}  // namespace

void half_phases(std::span<const double> x, double period, std::span<double> cosine, std::span<double> sine) {
  const double half = std::numbers::pi / period;
  Block C{}, S;
  for (std::size_t begin = 0; begin < x.size(); begin += block_size) {
    const std::size_t here = std::min(block_size, x.size() - begin);
    for (std::size_t i = 0; i < here; ++i) C[i] = half * x[begin + i];
    sweep_phases(C, S, whole_vectors(here));
    std::copy_n(C.begin(), here, cosine.begin() + begin);
    std::copy_n(S.begin(), here, sine.begin() + begin);
  }
}

void TrigonometricSeries::evaluate(const HalfPhases& points, std::span<double> out) const {
  sweeps().series({constant, cosine.data(), sine.data(), std::ssize(cosine)}, points.cosine.data(), points.sine.data(),
                  out.data(), std::ssize(out));
}

PeriodicSamples::PeriodicSamples(double period, std::size_t count) : x_(count), cosine_(count), sine_(count) {
  for (std::size_t i = 0; i < count; ++i) {
    const double turn = static_cast<double>(i) / static_cast<double>(count);
    x_[i] = period * turn;
    cosine_[i] = std::cos(2.0 * std::numbers::pi * turn);
    sine_[i] = std::sin(2.0 * std::numbers::pi * turn);
  }
}

void PeriodicSamples::interpolate(std::span<const double> values, double negligible,
                                  TrigonometricSeries& series) const {
  const std::size_t count = x_.size(), highest = (count - 1) / 2;
  series.constant = 0.0;
  for (const double value : values) series.constant += value / static_cast<double>(count);
  series.cosine.assign(highest, 0.0);
  series.sine.assign(highest, 0.0);
  for (std::size_t n = 1; n <= highest; ++n) {
    double a = 0.0, b = 0.0;
    for (std::size_t i = 0, turn = 0; i < count; ++i, turn = (turn + n) % count) {
      a += values[i] * cosine_[turn];
      b += values[i] * sine_[turn];
    }
    series.cosine[n - 1] = 2.0 * a / static_cast<double>(count);
    series.sine[n - 1] = 2.0 * b / static_cast<double>(count);
  }
  const auto small = [&](double coefficient) { return std::abs(coefficient) <= negligible; };
  while (!series.cosine.empty() && small(series.cosine.back()) && small(series.sine.back())) {
    series.cosine.pop_back();
    series.sine.pop_back();
  }
}

std::optional<TrigonometricSeries> trigonometric_series(const Field& field, double period, std::size_t most) {
  const PeriodicSamples samples(period, 4 * most + 3);
  std::vector<double> values(samples.x().size());
  field(samples.x(), values);
  double scale = 0.0;
  for (const double value : values) scale = std::max(scale, std::abs(value));
  if (!std::isfinite(scale)) return std::nullopt;
  TrigonometricSeries series;
  // What is left of a mode that is not there: round-off of the samples and of their sum.
  const double round_off = 4e-16 * scale;
  samples.interpolate(values, round_off, series);
  if (series.highest() > most) return std::nullopt;
  for (auto* coefficients : {&series.cosine, &series.sine}) {
    for (double& coefficient : *coefficients) {
      if (std::abs(coefficient) <= round_off) coefficient = 0.0;
    }
  }
  if (std::abs(series.constant) <= round_off) series.constant = 0.0;

  // Between the samples, at multiples of the golden ratio: no shorter wave hides there.
  constexpr std::size_t count = 256;
  std::vector<double> x(count), exact(count), approximate(count), C(count), S(count);
  for (std::size_t i = 0; i < count; ++i) x[i] = period * std::fmod(static_cast<double>(i) * std::numbers::phi, 1.0);
  field(x, exact);
  half_phases(x, period, C, S);
  series.evaluate({C, S}, approximate);
  for (std::size_t i = 0; i < count; ++i) {
    // not (gap <= ...), so that NaN refuses
    if (!(std::abs(exact[i] - approximate[i]) <= 8.0 * round_off)) return std::nullopt;
  }
  return series;
}

}  // namespace acstudy
