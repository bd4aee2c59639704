#pragma once

/// @file
/// The source of a case, or of several, at all particles of an ensemble.

#include <memory>
#include <optional>

#include "mms/line/source_series.hpp"
#include "studies/running/ensemble/shared_particles.hpp"

namespace acstudy {

/// A source at all particles, by its series if it has one; zero, and never computed, where the scene has none.
class ParticleSource {
 public:
  ParticleSource(const Scene& scene, const SourceSeries::MakeSource& make, bool sided, bool may_be_series,
                 std::size_t count)
      : f_(count) {
    if (scene.sourceless()) return;
    // More samples than particles would be no saving.
    if (may_be_series) series_ = SourceSeries::find(scene, make, sided, std::min<std::size_t>(count / 2, 96));
    if (!series_) direct_ = make(Look::upwind);
  }
  bool is_series() const { return series_.has_value(); }

  // f at time t: by a series, which is found once for all pieces of particles, or directly for all particles.
  void find_series(double t) {
    if (series_) series_->at(t);
  }
  void evaluate_series(const SharedParticles& particles, const Piece& piece, Laps& laps) {
    if (!series_) return;
    const auto c_hat = series_->sided() ? piece.of(particles.c_hat.values()) : std::span<const double>();
    series_->evaluate(particles.phases(piece), c_hat, piece.of(std::span(f_)));
    laps.end_of(seconds);
  }
  void evaluate_directly(double t, const SharedParticles& particles) {
    if (!direct_) return;
    if (placed_ != particles.times_moved()) direct_->place(particles.x.values());
    placed_ = particles.times_moved();
    direct_->evaluate(t, f_);
  }

  const double* f() const { return f_.data(); }
  std::int64_t quadrature_points() const {
    return series_ ? series_->quadrature_points() : direct_ ? direct_->quadrature_points() : 0;
  }

  double seconds = 0.0;

 private:
  std::optional<SourceSeries> series_;
  std::unique_ptr<Source> direct_;
  std::int64_t placed_ = 0;  ///< the move of the particles after which `direct_` was placed
  ZeroedVector f_;
};

}  // namespace acstudy
