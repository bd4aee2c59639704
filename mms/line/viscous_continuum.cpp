/// @file
/// The continuum of Model II: vanishing nonlocal viscosity, (3.7) and (3.9).

#include <fmt/format.h>

#include <algorithm>

#include "mms/line/point_fields.hpp"
#include "mms/nonlocal_source.hpp"

namespace acstudy {

namespace {

/// (3.7), (3.9): with F(z) = c_hat(x + z/2) (u(x) + u(x+z)) and z_q = +- delta node_q,
/// f = u_t + b u_x + [b' u | sum_q w_q mean b'(x + z_q/2) u] + sum_q w_q mean F'(z_q) - delta mu D.
class ViscousSource : public NonlocalSource {
 public:
  ViscousSource(const Scene& scene, const NonlocalModel& model, Rule rule, Rule viscous)
      : NonlocalSource(scene, model, std::move(rule)), viscous_(std::move(viscous)) {}

  void place(const Points& points) override {
    place_particles(points);
    const std::span<const double> x = points.line();
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

std::unique_ptr<Source> viscous_source(const Scene& scene, const NonlocalModel& model, std::size_t points, Look) {
  return std::make_unique<ViscousSource>(scene, model, derivative_rule(model.kernel, points),
                                         viscous_rule(model.kernel, points));
}

code::SourceFormula viscous_formula(const Scene& scene, const NonlocalModel& model, std::size_t points,
                                    const code::Language& in) {
  const auto of = [&](const char* name, const char* arguments) { return call(in, name, arguments); };
  const std::string weight = in.entry("gauss", "weight"), delta = in.own("delta");
  code::Sum sum{"gauss", derivative_rule(model.kernel, points), {}};
  code::Sum viscous{"viscous", viscous_rule(model.kernel, points), {}};
  sum.each.push_back({"z", fmt::format("{}*{}", delta, in.entry("gauss", "node"))});
  viscous.each.push_back({"z", fmt::format("{}*{}", delta, in.entry("viscous", "node"))});
  for (const auto& [midpoint, y] : {std::pair("x - 0.5*z", "x - z, t"), std::pair("x + 0.5*z", "x + z, t")}) {
    sum.each.push_back({"sum",
                        fmt::format("0.5*{}*(0.5*{}*({} + {}) + {}*{})", weight, of("c_hat_x", midpoint),
                                    of("u", "x, t"), of("u", y), of("c_hat", midpoint), of("u_x", y)),
                        true});
    if (model.nonlocal_divergence && !scene.standing()) {
      sum.each.push_back({"sum", fmt::format("0.5*{}*{}*{}", weight, of("b_x", midpoint), of("u", "x, t")), true});
    }
  }
  viscous.each.push_back({"sum",
                          fmt::format("(-0.5)*{}*{}*{}*({} - {})/z", delta, in.own("mu"), in.entry("viscous", "weight"),
                                      of("u_x", "x + z, t"), of("u_x", "x - z, t")),
                          true});
  return {{material_terms(scene, model, in)}, {sum, viscous}, {{"delta", model.delta}, {"mu", model.mu}}};
}

/// The slopes of the pair flux and, if it is nonlocal, of b over the distance r to both sides of x, and the bend of u.
std::function<double(double)> viscous_integrand(const Scene& scene, const NonlocalModel& model, double x, double t) {
  const PointFields at(scene, t);
  const bool nonlocal_divergence = model.nonlocal_divergence && !scene.standing();
  const double delta = model.delta, mu = model.mu, small = at.small();
  const PointValue u_at_x = at.u(x);
  const PointFunction b = [=](double y) { return at.b(y); }, u = [=](double y) { return at.u(y); };
  const PointFunction pair_flux = [=](double z) {
    const PointValue a = at.c_hat(x + 0.5 * z), v = at.u(x + z);
    return PointValue{a.value * (u_at_x.value + v.value), 0.5 * a.slope * (u_at_x.value + v.value) + a.value * v.slope};
  };
  return [=](double r) {
    const double advection = divided_difference(pair_flux, -r, r, small);
    const double divergence =
        nonlocal_divergence ? divided_difference(b, x - 0.5 * r, x + 0.5 * r, small) * u_at_x.value : 0.0;
    const double bend =
        r > 0.0 ? (divided_difference(u, x, x + r, small) - divided_difference(u, x - r, x, small)) / r : 0.0;
    return advection + divergence - delta * mu * 0.5 * bend;
  };
}

}  // namespace

const ContinuumModel viscous_continuum = {
    .source = viscous_source, .integrand = viscous_integrand, .sided = false, .formula = viscous_formula};

}  // namespace acstudy
