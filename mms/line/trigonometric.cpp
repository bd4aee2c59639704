#include "mms/line/trigonometric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mms/vector_math.hpp"
#include "solver/line/vector/sweeps.hpp"

namespace acstudy {

namespace {

/// cosine holds x at first.  @pre n is a multiple of vector_width, so that every element takes the same path
ACSTUDY_VECTOR_CLONES void sweep_phases(double w, double* cosine, double* sine, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) sine[i] = std::sin(w * cosine[i]);
  for (std::size_t i = 0; i < n; ++i) cosine[i] = std::cos(w * cosine[i]);
}

/// cosine and sine hold q and p at first.  @pre as above
ACSTUDY_VECTOR_CLONES void sweep_angles(double scale, double* cosine, double* sine, double* x, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) x[i] = scale * std::atan2(sine[i], cosine[i]);
}

ACSTUDY_VECTOR_CLONES void normalize(double* cosine, double* sine, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const double per_length = 1.0 / std::sqrt(cosine[i] * cosine[i] + sine[i] * sine[i]);
    cosine[i] *= per_length;
    sine[i] *= per_length;
  }
}

/// cos 2a = (q^2 - p^2)/(p^2 + q^2), sin 2a = 2 p q/(p^2 + q^2) of a = atan2(p, q).
ACSTUDY_VECTOR_CLONES void normalize_twice(double* cosine, double* sine, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const double q = cosine[i], p = sine[i], per_square = 1.0 / (q * q + p * p);
    cosine[i] = (q - p) * (q + p) * per_square;
    sine[i] = 2.0 * p * q * per_square;
  }
}

/// Calls sweep(arrays..., n) with n a multiple of vector_width; the rest of the arrays is filled up to a whole vector.
template <class Sweep, class... Arrays>
void in_whole_vectors(Sweep&& sweep, std::size_t size, Arrays*... arrays) {
  const std::size_t whole = size / vector_width * vector_width, rest = size - whole;
  sweep(arrays..., whole);
  if (rest == 0) return;
  const auto with_rest = [&](auto... last) {
    (std::copy_n(arrays + whole, rest, last.begin()), ...);
    sweep(last.data()..., vector_width);
    (std::copy_n(last.begin(), rest, arrays + whole), ...);
  };
  with_rest(std::array<Arrays, vector_width>{}...);
}

}  // namespace

void phases(std::span<const double> x, double period, const PhasesOut& out) {
  const auto fill = [&](double w, std::span<double> cosine, std::span<double> sine) {
    if (cosine.empty()) return;
    std::copy(x.begin(), x.end(), cosine.begin());
    in_whole_vectors([w](auto... arrays_and_n) { sweep_phases(w, arrays_and_n...); }, x.size(), cosine.data(),
                     sine.data());
  };
  fill(2.0 * std::numbers::pi / period, out.cosine, out.sine);
  fill(std::numbers::pi / period, out.half_cosine, out.half_sine);
}

void phases_of_angles(double period, std::span<double> x, const PhasesOut& out) {
  double *const C = out.cosine.data(), *const S = out.sine.data();
  in_whole_vectors([&](auto... arrays_and_n) { sweep_angles(period / std::numbers::pi, arrays_and_n...); }, x.size(), C,
                   S, x.data());
  if (!out.half_cosine.empty()) {
    std::copy_n(C, x.size(), out.half_cosine.begin());
    std::copy_n(S, x.size(), out.half_sine.begin());
    normalize(out.half_cosine.data(), out.half_sine.data(), x.size());
  }
  normalize_twice(C, S, x.size());
}

void TrigonometricSeries::evaluate(const Phases& points, std::span<double> out) const {
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
  // A mode that the field does not have comes out as the round-off of the samples and of their sum.
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
  phases(x, period, {C, S, {}, {}});
  series.evaluate({C, S}, approximate);
  for (std::size_t i = 0; i < count; ++i) {
    // not (gap <= ...), so that NaN refuses
    if (!(std::abs(exact[i] - approximate[i]) <= 8.0 * round_off)) return std::nullopt;
  }
  return series;
}

}  // namespace acstudy
