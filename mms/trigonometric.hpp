#pragma once

/// @file
/// Smooth periodic fields as short trigonometric series: what costs a sweep over an expression becomes a few
/// multiplications at points whose phases are known.

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace acstudy {

/// The phases w x/2 of points, w = 2 pi/period, by their cosine and sine. Midpoints of two points have their sum as
/// phase w x, which is why halves are kept.
struct HalfPhases {
  std::span<const double> cosine, sine;
};

/// Fills cosine and sine of w x/2 for all points.
void half_phases(std::span<const double> x, double period, std::span<double> cosine, std::span<double> sine);

/// a_0 + sum_n cosine_n cos(n w x) + sine_n sin(n w x), n = 1 .. highest.
struct TrigonometricSeries {
  double constant = 0.0;
  std::vector<double> cosine, sine;  ///< of mode n at n - 1

  std::size_t highest() const { return cosine.size(); }
  /// The series at points given by their phases.
  void evaluate(const HalfPhases& points, std::span<double> out) const;
};

/// Equally spaced samples of a period and the series through them.
class PeriodicSamples {
 public:
  /// @param count  of samples, >= 2; modes up to (count - 1)/2 can be told apart
  PeriodicSamples(double period, std::size_t count);
  const std::vector<double>& x() const { return x_; }
  /// The series that takes these values; trailing modes of no more than `negligible` are left out.
  void interpolate(std::span<const double> values, double negligible, TrigonometricSeries& series) const;

 private:
  std::vector<double> x_, cosine_, sine_;  ///< cos and sin of 2 pi i/count
};

/// A field by its values at points.
using Field = std::function<void(std::span<const double> x, std::span<double> out)>;

/// The series of a field of at most `most` modes that agrees with it to round-off, if there is one.
std::optional<TrigonometricSeries> trigonometric_series(const Field& field, double period, std::size_t most);

}  // namespace acstudy
