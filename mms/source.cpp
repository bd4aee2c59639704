#include "mms/source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "mms/line/adaptive.hpp"
#include "mms/nonlocal_source.hpp"

namespace acstudy {

namespace {

class LocalSource : public Source {
 public:
  explicit LocalSource(const Scene& scene) : scene_(scene) {}

  void place(const Points& x) override {
    x_.assign(x);
    for (auto* values : {&c_, &u_x_}) values->resize(x.size(), x.dimension());
    for (auto* values : {&c_prime_, &u_, &u_t_}) values->resize(x.size());
    scene_.c(x, c_, c_prime_);
  }

  void evaluate(double t, std::span<double> f) override {
    scene_.u(x_, t, u_, u_x_, u_t_);
    std::copy(u_t_.begin(), u_t_.end(), f.begin());
    add_products(c_, u_x_, f);
    for (std::size_t j = 0; j < f.size(); ++j) f[j] += c_prime_[j] * u_[j];
  }

 private:
  const Scene& scene_;
  PointArray x_, c_, u_x_;
  Values c_prime_, u_, u_t_;
};

/// The source of a scene whose solution is not known.
class GivenSource : public Source {
 public:
  explicit GivenSource(const Scene& scene) : scene_(scene) {}

  void place(const Points& x) override { x_.assign(x); }

  void evaluate(double t, std::span<double> f) override {
    scene_.sourceless() ? std::fill(f.begin(), f.end(), 0.0) : scene_.f(x_, t, f);
  }

 private:
  const Scene& scene_;
  PointArray x_;
};

/// The reference: every integral adaptively, straight from its definition.
class AdaptiveSource : public NonlocalSource {
 public:
  AdaptiveSource(const Scene& scene, const NonlocalModel& model, SourceRule rule)
      : NonlocalSource(scene, model, {}), rule_(rule) {}

  void place(const Points& x) override { place_particles(x); }

  void evaluate(double t, std::span<double> f) override {
    material_terms(t, f);
    for (std::size_t j = 0; j < f.size(); ++j) {
      f[j] += nonlocal_terms_adaptively(scene_, model_, rule_, x_(j, 0), t, quadrature_points_);
    }
  }

 private:
  SourceRule rule_;
};

/// A source at sample points of the scene, to compare others with.
class SourceSamples {
 public:
  SourceSamples(const Scene& scene, Source& source) {
    constexpr std::size_t steps[most_dimensions] = {1, 23, 37};  // beyond a line a lattice
    x_.resize(count, scene.dimension());
    for (std::size_t k = 0; k < x_.dimension; ++k) {
      for (std::size_t i = 0; i < count; ++i) {
        x_(i, k) = scene.periods()[k] * static_cast<double>(i * steps[k] % count) / count;
      }
    }
    source.place(x_);
    Velocities velocity;
    velocity.evaluate(scene, x_);
    Values u(count), u_t(count);
    PointArray u_x;
    u_x.resize(count, x_.dimension);
    for (const double fraction : {0.0, 0.5, 1.0}) {
      Sample& sample = samples_.emplace_back(Sample{fraction * scene.T(), Values(count)});
      source.evaluate(sample.t, sample.f);
      scene.u(x_, sample.t, u, u_x, u_t);
      for (std::size_t i = 0; i < count; ++i) {
        double flux = 0.0;
        for (std::size_t k = 0; k < x_.dimension; ++k) flux += std::abs(velocity.c_hat[k * count + i] * u_x(i, k));
        flux += std::abs(velocity.c_hat_prime[i] * u[i]);
        scale_ = std::max({scale_, std::abs(sample.f[i]), std::abs(u_t[i]) + flux});
      }
    }
  }

  /// The largest gap to another source, relative to the largest sum of the terms that they add up; the sources
  /// themselves may cancel to nothing.
  double disagreement(Source& other) const {
    Values f(count);
    other.place(x_);
    double gap = 0.0;
    for (const Sample& sample : samples_) {
      other.evaluate(sample.t, f);
      for (std::size_t i = 0; i < count; ++i) {
        const double difference = std::abs(f[i] - sample.f[i]);
        gap = std::max(gap, std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference);
      }
    }
    return gap == 0.0 ? 0.0 : gap / scale_;
  }

 private:
  static constexpr std::size_t count = 61;
  struct Sample {
    double t;
    Values f;
  };
  PointArray x_;
  std::vector<Sample> samples_;
  double scale_ = 0.0;
};

}  // namespace

std::unique_ptr<Source> local_source(const Scene& scene) {
  if (!scene.solved()) return std::make_unique<GivenSource>(scene);
  return std::make_unique<LocalSource>(scene);
}

std::unique_ptr<Source> nonlocal_source(const Scene& scene, const NonlocalModel& model, std::size_t points, Look look) {
  return model.continuum->source(scene, model, points, look);
}

std::size_t sufficient_points(const Scene& scene, const NonlocalModel& model) {
  // Between 1e-14, the round-off of the sums, and 1e-13, what the fixed rule promises; for a field of very short waves
  // what round-off in its argument leaves, which two fine rules show.
  constexpr double promised = 3e-14, acceptable = 1e-10;
  constexpr std::size_t most = 40;
  const SourceSamples reference(scene, *nonlocal_source(scene, model, most + 8));
  const double round_off = reference.disagreement(*nonlocal_source(scene, model, most));
  if (round_off <= acceptable) {
    const double tolerance = std::max(promised, 2.0 * round_off);
    for (std::size_t points = 2; points <= most; ++points) {
      if (reference.disagreement(*nonlocal_source(scene, model, points)) <= tolerance) return points;
    }
  }
  throw std::domain_error(
      fmt::format("no Gauss rule of up to {} points integrates the source at delta = {:.6g} to round-off; "
                  "the fields vary too fast within the horizon: use rule = \"gsl\" or \"boost\"",
                  most, model.delta));
}

std::unique_ptr<Source> nonlocal_source(const Scene& scene, const NonlocalModel& model, SourceRule rule,
                                        std::size_t refinement) {
  if (rule != SourceRule::gauss) return std::make_unique<AdaptiveSource>(scene, model, rule);
  return nonlocal_source(scene, model, refinement * sufficient_points(scene, model));
}

}  // namespace acstudy
