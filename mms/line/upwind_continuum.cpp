/// @file
/// The continuum of Model I: the upwind kernel, (2.8) and (2.10).

#include <fmt/format.h>

#include <algorithm>

#include "mms/line/point_fields.hpp"
#include "mms/nonlocal_source.hpp"

namespace acstudy {

namespace {

/// (2.8), (2.10): with the upwind points y_q = x - s delta z_q, s = +1 where c_hat > 0,
/// f = u_t + b u_x + [b' u | sum_q w_q b'(y_q) u] + sum_q w_q (c_hat u)'(y_q).
class UpwindSource : public NonlocalSource {
 public:
  UpwindSource(const Scene& scene, const NonlocalModel& model, Rule rule, Look look)
      : NonlocalSource(scene, model, std::move(rule)), look_(look) {}

  void place(const Points& points) override {
    place_particles(points);
    const std::span<const double> x = points.line();
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

std::unique_ptr<Source> upwind_source(const Scene& scene, const NonlocalModel& model, std::size_t points, Look look) {
  return std::make_unique<UpwindSource>(scene, model, derivative_rule(model.kernel, points), look);
}

code::SourceFormula upwind_formula(const Scene& scene, const NonlocalModel& model, std::size_t points,
                                   const code::Language& in) {
  const auto at_y = [&](const char* name, const char* arguments = "y") { return call(in, name, arguments); };
  const std::string weight = in.entry("gauss", "weight");
  code::Sum sum{"gauss", derivative_rule(model.kernel, points), {}};
  sum.each.push_back(
      {"y", fmt::format("x - {}*{}*{}", call(in, "side", "x"), in.own("delta"), in.entry("gauss", "node"))});
  sum.each.push_back({"sum",
                      fmt::format("{}*({}*{} + {}*{})", weight, at_y("c_hat_x"), at_y("u", "y, t"), at_y("c_hat"),
                                  at_y("u_x", "y, t")),
                      true});
  if (model.nonlocal_divergence && !scene.standing()) {
    sum.each.push_back({"sum", fmt::format("{}*{}*{}", weight, at_y("b_x"), call(in, "u", "x, t")), true});
  }
  return {{material_terms(scene, model, in)}, {sum}, {{"delta", model.delta}}};
}

/// The slopes of c_hat u and, if it is nonlocal, of b over the distance r upwind of x.
std::function<double(double)> upwind_integrand(const Scene& scene, const NonlocalModel& model, double x, double t) {
  const PointFields at(scene, t);
  const bool nonlocal_divergence = model.nonlocal_divergence && !scene.standing();
  const double s = at.c_hat(x).value > 0.0 ? 1.0 : -1.0, small = at.small();
  const PointValue u_at_x = at.u(x);
  const PointFunction b = [=](double y) { return at.b(y); };
  const PointFunction flux = [=](double y) {
    const PointValue a = at.c_hat(y), v = at.u(y);
    return PointValue{a.value * v.value, a.slope * v.value + a.value * v.slope};
  };
  return [=](double r) {
    const double left = std::min(x, x - s * r), right = std::max(x, x - s * r);
    const double divergence = nonlocal_divergence ? divided_difference(b, left, right, small) * u_at_x.value : 0.0;
    return divided_difference(flux, left, right, small) + divergence;
  };
}

}  // namespace

const ContinuumModel upwind_continuum = {
    .source = upwind_source, .integrand = upwind_integrand, .sided = true, .formula = upwind_formula};

}  // namespace acstudy
