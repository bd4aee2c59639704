#pragma once

/// @file
/// A manufactured source as a trigonometric series: computed at a few samples of the period, not at every particle.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mms/line/trigonometric.hpp"
#include "mms/source.hpp"

namespace acstudy {

/// A source whose fields are smooth: at every time a series of few modes, one for particles that look left and one
/// for those that look right where that makes a difference (Model I, nonlocal).
class SourceSeries {
 public:
  /// Makes the source that looks to one side everywhere.
  using MakeSource = std::function<std::unique_ptr<Source>(Look)>;

  /// The series, if one of at most `most` samples agrees with the source to 1e-13 of its terms, between the samples and
  /// at several times.
  /// @param sided  false where both sides have the same source
  static std::optional<SourceSeries> find(const Scene& scene, const MakeSource& make, bool sided, std::size_t most);

  /// Computes the series at time t.
  void at(double t);
  /// f at particles given by their phases, at the time of `at`.
  /// @param c_hat  relative velocity: particles with c_hat > 0 look left; read only where the series is sided
  void evaluate(const Phases& particles, std::span<const double> c_hat, std::span<double> out) const;

  bool sided() const { return sides_.size() == 2; }
  std::size_t samples() const { return samples_.x().size(); }
  /// Integrand evaluations so far.
  std::int64_t quadrature_points() const;

 private:
  struct Side {
    std::unique_ptr<Source> source;
    TrigonometricSeries series;
  };
  SourceSeries(const Scene& scene, const MakeSource& make, bool sided, std::size_t count);

  PeriodicSamples samples_;
  std::vector<Side> sides_;  ///< that which looks left, and the other if it differs
  std::vector<double> values_;
};

}  // namespace acstudy
