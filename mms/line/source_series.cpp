#include "mms/line/source_series.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace acstudy {

SourceSeries::SourceSeries(const Scene& scene, const MakeSource& make, bool sided, std::size_t count)
    : samples_(scene.period(), count), values_(count) {
  sides_.push_back({make(Look::left), {}});
  if (sided) sides_.push_back({make(Look::right), {}});
  for (Side& side : sides_) side.source->place(samples_.x());
}

void SourceSeries::at(double t) {
  for (Side& side : sides_) {
    side.source->evaluate(t, values_);
    double scale = 0.0;
    for (const double value : values_) scale = std::max(scale, std::abs(value));
    samples_.interpolate(values_, 1e-16 * scale, side.series);
  }
}

void SourceSeries::evaluate(const Phases& particles, std::span<const double> c_hat, std::span<double> out) const {
  if (!sided()) return sides_.front().series.evaluate(particles, out);
  // Particles that look to the same side stand together.
  for (std::size_t begin = 0, end = 0; begin < out.size(); begin = end) {
    const bool left = c_hat[begin] > 0.0;
    while (end < out.size() && (c_hat[end] > 0.0) == left) ++end;
    const auto part = [&](auto values) { return values.subspan(begin, end - begin); };
    sides_[left ? 0 : 1].series.evaluate({part(particles.cosine), part(particles.sine)}, part(out));
  }
}

std::int64_t SourceSeries::quadrature_points() const {
  std::int64_t points = 0;
  for (const Side& side : sides_) points += side.source->quadrature_points();
  return points;
}

std::optional<SourceSeries> SourceSeries::find(const Scene& scene, const MakeSource& make, bool sided,
                                               std::size_t most) {
  constexpr std::size_t count = 64;
  constexpr double agreement = 1e-13;
  std::vector<double> x(count), exact(count), approximate(count), C(count), S(count), u(count), u_x(count), u_t(count);
  for (std::size_t i = 0; i < count; ++i) {
    x[i] = scene.period() * std::fmod(static_cast<double>(i) * std::numbers::phi, 1.0);
  }
  phases(x, scene.period(), {C, S, {}, {}});
  std::vector<std::unique_ptr<Source>> direct;
  direct.push_back(make(Look::left));
  if (sided) direct.push_back(make(Look::right));
  for (const auto& source : direct) source->place(x);

  for (std::size_t samples = 8; samples <= most; samples += samples / 2) {
    SourceSeries series(scene, make, sided, samples);
    bool agrees = true;
    for (const double fraction : {0.0, 0.21, 0.5, 0.83, 1.0}) {
      const double t = fraction * scene.T();
      series.at(t);
      scene.u(x, t, u, u_x, u_t);
      for (std::size_t side = 0; side < direct.size(); ++side) {
        direct[side]->evaluate(t, exact);
        series.sides_[side].series.evaluate({C, S}, approximate);
        double scale = 0.0, gap = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
          scale = std::max({scale, std::abs(exact[i]), std::abs(u_t[i]), std::abs(u_x[i])});
          const double difference = std::abs(exact[i] - approximate[i]);
          if (!(difference <= gap)) gap = difference;  // NaN stays
        }
        agrees = agrees && gap <= agreement * scale;
      }
      if (!agrees) break;
    }
    if (agrees) return series;
  }
  return std::nullopt;
}

}  // namespace acstudy
