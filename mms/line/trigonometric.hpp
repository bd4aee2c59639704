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

/// The phases w x of points, w = 2 pi/period, by their cosine and sine.
struct Phases {
  std::span<const double> cosine, sine;
};

/// Where phases go, and halves of them, unless these are empty. Midpoints of two points have the sum of their halves as
/// phase.
struct PhasesOut {
  std::span<double> cosine, sine, half_cosine, half_sine;
};

/// Fills the phases of all points.
void phases(std::span<const double> x, double period, const PhasesOut& out);

/// Fills x = period/pi atan2(p, q) for all points and their phases, w x/2 = atan2(p, q), by arithmetic alone.
/// @param out  its cosine and sine hold q and p at first
void phases_of_angles(double period, std::span<double> x, const PhasesOut& out);

/// a_0 + sum_n cosine_n cos(n w x) + sine_n sin(n w x), n = 1 .. highest.
struct TrigonometricSeries {
  double constant = 0.0;
  std::vector<double> cosine, sine;  ///< of mode n at n - 1

  std::size_t highest() const { return cosine.size(); }
  /// The series at points given by their phases.
  void evaluate(const Phases& points, std::span<double> out) const;
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
