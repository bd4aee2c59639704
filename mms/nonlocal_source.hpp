#pragma once

/// @file
/// What the sources of nonlocal models share: velocities at points, and the terms along trajectories.

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mms/code/scene_code.hpp"
#include "mms/source.hpp"

namespace acstudy {

using Values = std::vector<double>;

/// out_j += a_j b_j, the scalar product of vectors.
inline void add_products(const Points& a, const Points& b, std::span<double> out) {
  for (std::size_t k = 0; k < a.dimension(); ++k) {
    for (std::size_t j = 0; j < out.size(); ++j) out[j] += a[k][j] * b[k][j];
  }
}

/// Velocities at a set of points: c_hat and b, shape [d, N], and their derivatives, beyond a line divergences; those of
/// b empty where nothing moves.
struct Velocities {
  Values c_hat, c_hat_prime, b, b_prime;

  void evaluate(const Scene& scene, const Points& x) {
    const std::size_t d = x.dimension();
    c_hat.resize(d * x.size());
    c_hat_prime.resize(x.size());
    scene.c(x, Vectors::blocks(c_hat, d), c_hat_prime);
    if (scene.standing()) return;
    b.resize(d * x.size());
    b_prime.resize(x.size());
    scene.b(x, Vectors::blocks(b, d), b_prime);
    for (std::size_t i = 0; i < b.size(); ++i) c_hat[i] -= b[i];
    for (std::size_t i = 0; i < b_prime.size(); ++i) c_hat_prime[i] -= b_prime[i];
  }
};

/// What nonlocal models share: du/dt along trajectories and the local divergence.
class NonlocalSource : public Source {
 public:
  NonlocalSource(const Scene& scene, const NonlocalModel& model, Rule rule)
      : scene_(scene), model_(model), rule_(std::move(rule)) {}

  std::int64_t quadrature_points() const override { return quadrature_points_; }

 protected:
  void place_particles(const Points& x) {
    x_.assign(x);
    at_x_.evaluate(scene_, x);
    u_x_.resize(x.size(), x.dimension());
    for (auto* values : {&u_, &u_t_}) values->resize(x.size());
  }
  /// f_j = u_t + b u_x, plus b' u if the divergence is local.
  void material_terms(double t, std::span<double> f) {
    scene_.u(x_, t, u_, u_x_, u_t_);
    std::copy(u_t_.begin(), u_t_.end(), f.begin());
    if (scene_.standing()) return;
    add_products(Points::blocks(at_x_.b, u_x_.dimension), u_x_, f);
    for (std::size_t j = 0; j < f.size() && !model_.nonlocal_divergence; ++j) f[j] += at_x_.b_prime[j] * u_[j];
  }
  bool nonlocal_divergence() const { return model_.nonlocal_divergence && !scene_.standing(); }

  const Scene& scene_;
  NonlocalModel model_;
  Rule rule_;
  Velocities at_x_;
  PointArray x_, u_x_;
  Values u_, u_t_;
  std::int64_t quadrature_points_ = 0;
};

/// The same as a statement in another language: sum = what it is.
inline code::Statement material_terms(const Scene& scene, const NonlocalModel& model, const code::Language& in) {
  std::string f = call(in, "u_t", "x, t");
  if (scene.standing()) return {"sum", f};
  f += " + " + call(in, "b", "x") + "*" + call(in, "u_x", "x, t");
  if (!model.nonlocal_divergence) f += " + " + call(in, "b_x", "x") + "*" + call(in, "u", "x, t");
  return {"sum", f};
}

}  // namespace acstudy
