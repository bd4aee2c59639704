#include "mms/source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "mms/adaptive.hpp"

namespace acstudy {

namespace {

using Values = std::vector<double>;

class LocalSource : public Source {
 public:
  explicit LocalSource(const Scene& scene) : scene_(scene) {}

  void place(std::span<const double> x) override {
    x_.assign(x.begin(), x.end());
    for (auto* values : {&c_, &c_prime_, &u_, &u_x_, &u_t_}) values->resize(x.size());
    scene_.c(x, c_, c_prime_);
  }

  void evaluate(double t, std::span<double> f) override {
    scene_.u(x_, t, u_, u_x_, u_t_);
    for (std::size_t j = 0; j < f.size(); ++j) f[j] = u_t_[j] + c_[j] * u_x_[j] + c_prime_[j] * u_[j];
  }

 private:
  const Scene& scene_;
  Values x_, c_, c_prime_, u_, u_x_, u_t_;
};

/// The source of a scene whose solution is not known.
class GivenSource : public Source {
 public:
  explicit GivenSource(const Scene& scene) : scene_(scene) {}

  void place(std::span<const double> x) override { x_.assign(x.begin(), x.end()); }

  void evaluate(double t, std::span<double> f) override {
    scene_.sourceless() ? std::fill(f.begin(), f.end(), 0.0) : scene_.f(x_, t, f);
  }

 private:
  const Scene& scene_;
  Values x_;
};

/// Velocities at a set of points: c_hat and its derivative, b and its derivative; the latter empty where nothing moves.
struct Velocities {
  Values c_hat, c_hat_prime, b, b_prime;

  void evaluate(const Scene& scene, std::span<const double> x) {
    c_hat.resize(x.size());
    c_hat_prime.resize(x.size());
    scene.c(x, c_hat, c_hat_prime);
    if (scene.standing()) return;
    b.resize(x.size());
    b_prime.resize(x.size());
    scene.b(x, b, b_prime);
    for (std::size_t i = 0; i < x.size(); ++i) {
      c_hat[i] -= b[i];
      c_hat_prime[i] -= b_prime[i];
    }
  }
};

/// What both models share: du/dt along trajectories and the local divergence.
class NonlocalSource : public Source {
 public:
  NonlocalSource(const Scene& scene, const NonlocalModel& model, Rule rule)
      : scene_(scene), model_(model), rule_(std::move(rule)) {}

  std::int64_t quadrature_points() const override { return quadrature_points_; }

 protected:
  void place_particles(std::span<const double> x) {
    x_.assign(x.begin(), x.end());
    at_x_.evaluate(scene_, x);
    for (auto* values : {&u_, &u_x_, &u_t_}) values->resize(x.size());
  }
  /// f_j = u_t + b u_x, plus b' u if the divergence is local.
  void material_terms(double t, std::span<double> f) {
    scene_.u(x_, t, u_, u_x_, u_t_);
    std::copy(u_t_.begin(), u_t_.end(), f.begin());
    if (scene_.standing()) return;
    for (std::size_t j = 0; j < f.size(); ++j) {
      f[j] += at_x_.b[j] * u_x_[j];
      if (!model_.nonlocal_divergence) f[j] += at_x_.b_prime[j] * u_[j];
    }
  }
  bool nonlocal_divergence() const { return model_.nonlocal_divergence && !scene_.standing(); }

  const Scene& scene_;
  NonlocalModel model_;
  Rule rule_;
  Velocities at_x_;
  Values x_, u_, u_x_, u_t_;
  std::int64_t quadrature_points_ = 0;
};

/// (2.8), (2.10): with the upwind points y_q = x - s delta z_q, s = +1 where c_hat > 0,
/// f = u_t + b u_x + [b' u | sum_q w_q b'(y_q) u] + sum_q w_q (c_hat u)'(y_q).
class ModelISource : public NonlocalSource {
 public:
  ModelISource(const Scene& scene, const NonlocalModel& model, Rule rule, Look look)
      : NonlocalSource(scene, model, std::move(rule)), look_(look) {}

  void place(std::span<const double> x) override {
    place_particles(x);
    const std::size_t m = rule_.size();
    for (auto* values : {&y_, &u_y_, &u_x_y_}) values->resize(x.size() * m);
    for (std::size_t j = 0; j < x.size(); ++j) {
      const bool left = look_ == Look::upwind ? at_x_.c_hat[j] > 0.0 : look_ == Look::left;
      const double s = left ? 1.0 : -1.0;
      for (std::size_t q = 0; q < m; ++q) y_[j * m + q] = x[j] - s * model_.delta * rule_.node[q];
    }
    at_y_.evaluate(scene_, y_);
  }

  void evaluate(double t, std::span<double> f) override {
    material_terms(t, f);
    scene_.u(y_, t, u_y_, u_x_y_);
    const std::size_t m = rule_.size();
    for (std::size_t j = 0; j < f.size(); ++j) {
      double flux = 0.0, divergence = 0.0;
      for (std::size_t q = 0, i = j * m; q < m; ++q, ++i) {
        flux += rule_.weight[q] * (at_y_.c_hat_prime[i] * u_y_[i] + at_y_.c_hat[i] * u_x_y_[i]);
        if (nonlocal_divergence()) divergence += rule_.weight[q] * at_y_.b_prime[i];
      }
      f[j] += flux + divergence * u_[j];
    }
    quadrature_points_ += static_cast<std::int64_t>(y_.size());
  }

 private:
  Look look_;
  Values y_, u_y_, u_x_y_;
  Velocities at_y_;
};

/// (3.7), (3.9): with F(z) = c_hat(x + z/2) (u(x) + u(x+z)) and z_q = +- delta node_q,
/// f = u_t + b u_x + [b' u | sum_q w_q mean b'(x + z_q/2) u] + sum_q w_q mean F'(z_q) - delta mu D.
class ModelIISource : public NonlocalSource {
 public:
  ModelIISource(const Scene& scene, const NonlocalModel& model, Rule rule, Rule viscous)
      : NonlocalSource(scene, model, std::move(rule)), viscous_(std::move(viscous)) {}

  void place(std::span<const double> x) override {
    place_particles(x);
    const std::size_t m = rule_.size(), v = viscous_.size();
    for (auto* values : {&midpoint_, &y_, &u_y_, &u_x_y_}) values->resize(2 * m * x.size());
    for (auto* values : {&r_, &u_x_r_}) values->resize(2 * v * x.size());
    for (std::size_t j = 0, i = 0, k = 0; j < x.size(); ++j) {
      for (const double side : {-1.0, 1.0}) {
        for (std::size_t q = 0; q < m; ++q, ++i) {
          const double z = side * model_.delta * rule_.node[q];
          y_[i] = x[j] + z;
          midpoint_[i] = x[j] + 0.5 * z;
        }
        for (std::size_t q = 0; q < v; ++q, ++k) r_[k] = x[j] + side * model_.delta * viscous_.node[q];
      }
    }
    at_midpoint_.evaluate(scene_, midpoint_);
  }

  void evaluate(double t, std::span<double> f) override {
    material_terms(t, f);
    scene_.u(y_, t, u_y_, u_x_y_);
    scene_.u(r_, t, {}, u_x_r_);
    const std::size_t m = rule_.size(), v = viscous_.size();
    for (std::size_t j = 0; j < f.size(); ++j) {
      double A = 0.0, B = 0.0, D = 0.0;
      for (std::size_t q = 0, i = 2 * m * j; q < 2 * m; ++q, ++i) {
        const double w = 0.5 * rule_.weight[q % m];
        A += w * (0.5 * at_midpoint_.c_hat_prime[i] * (u_[j] + u_y_[i]) + at_midpoint_.c_hat[i] * u_x_y_[i]);
        if (nonlocal_divergence()) B += w * at_midpoint_.b_prime[i];
      }
      const double* const left = u_x_r_.data() + 2 * v * j;
      for (std::size_t q = 0; q < v; ++q) {
        D += 0.5 * viscous_.weight[q] * (left[v + q] - left[q]) / (model_.delta * viscous_.node[q]);
      }
      f[j] += A + B * u_[j] - model_.delta * model_.mu * D;
    }
    quadrature_points_ += static_cast<std::int64_t>(y_.size() + r_.size());
  }

 private:
  Rule viscous_;
  Values midpoint_, y_, u_y_, u_x_y_, r_, u_x_r_;
  Velocities at_midpoint_;
};

/// The reference: every integral adaptively, straight from its definition.
class AdaptiveSource : public NonlocalSource {
 public:
  AdaptiveSource(const Scene& scene, const NonlocalModel& model, SourceRule rule)
      : NonlocalSource(scene, model, {}), rule_(rule) {}

  void place(std::span<const double> x) override { place_particles(x); }

  void evaluate(double t, std::span<double> f) override {
    material_terms(t, f);
    for (std::size_t j = 0; j < f.size(); ++j) {
      f[j] += nonlocal_terms_adaptively(scene_, model_, rule_, x_[j], t, quadrature_points_);
    }
  }

 private:
  SourceRule rule_;
};

/// A source at sample points of the scene, to compare others with.
class SourceSamples {
 public:
  SourceSamples(const Scene& scene, Source& source) : x_(count) {
    for (std::size_t i = 0; i < count; ++i) x_[i] = scene.period() * static_cast<double>(i) / count;
    source.place(x_);
    Velocities velocity;
    velocity.evaluate(scene, x_);
    Values u(count), u_x(count), u_t(count);
    for (const double fraction : {0.0, 0.5, 1.0}) {
      Sample& sample = samples_.emplace_back(Sample{fraction * scene.T(), Values(count)});
      source.evaluate(sample.t, sample.f);
      scene.u(x_, sample.t, u, u_x, u_t);
      for (std::size_t i = 0; i < count; ++i) {
        const double flux = std::abs(velocity.c_hat[i] * u_x[i]) + std::abs(velocity.c_hat_prime[i] * u[i]);
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
  Values x_;
  std::vector<Sample> samples_;
  double scale_ = 0.0;
};

}  // namespace

std::unique_ptr<Source> local_source(const Scene& scene) {
  if (!scene.solved()) return std::make_unique<GivenSource>(scene);
  return std::make_unique<LocalSource>(scene);
}

std::unique_ptr<Source> nonlocal_source(const Scene& scene, const NonlocalModel& model, std::size_t points, Look look) {
  if (model.model == 1) {
    return std::make_unique<ModelISource>(scene, model, derivative_rule(model.kernel, points), look);
  }
  return std::make_unique<ModelIISource>(scene, model, derivative_rule(model.kernel, points),
                                         viscous_rule(model.kernel, points));
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
