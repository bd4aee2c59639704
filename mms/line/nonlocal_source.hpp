#pragma once

/// @file
/// What the sources of nonlocal models share: velocities at points, and the terms along trajectories.

#include <algorithm>
#include <utility>
#include <vector>

#include "mms/source.hpp"

namespace acstudy {

using Values = std::vector<double>;

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

/// What nonlocal models share: du/dt along trajectories and the local divergence.
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

/// A field and its derivative at a point.
struct PointValue {
  double value = 0.0, slope = 0.0;
};

/// The fields of a scene at single points, at the time t.
class PointFields {
 public:
  PointFields(const Scene& scene, double t) : scene_(scene), t_(t) {}
  PointValue u(double y) const {
    PointValue p;
    scene_.u({&y, 1}, t_, {&p.value, 1}, {&p.slope, 1});
    return p;
  }
  PointValue b(double y) const {
    PointValue p;
    if (!scene_.standing()) scene_.b({&y, 1}, {&p.value, 1}, {&p.slope, 1});
    return p;
  }
  PointValue c_hat(double y) const {
    PointValue p;
    scene_.c({&y, 1}, {&p.value, 1}, {&p.slope, 1});
    const PointValue particle = b(y);
    return {p.value - particle.value, p.slope - particle.slope};
  }
  /// A gap below which a divided difference is taken as the average of the slope.
  double small() const { return 1e-3 * scene_.period(); }

 private:
  const Scene& scene_;
  double t_;
};

using PointFunction = std::function<PointValue(double)>;

/// (g(right) - g(left)) / (right - left) without cancellation: below `small` the average of g' by a Gauss rule, which
/// is exact to round-off for waves down to the length `small`.
double divided_difference(const PointFunction& g, double left, double right, double small);

}  // namespace acstudy
