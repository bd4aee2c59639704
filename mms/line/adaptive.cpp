#include "mms/line/adaptive.hpp"

#include <fmt/format.h>
#include <gsl/gsl_integration.h>

#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "mms/gsl_status.hpp"
#include "mms/line/point_fields.hpp"

namespace acstudy {

namespace {

using Function = std::function<double(double)>;

constexpr double tolerance = 1e-14;

/// int_lower^upper g(z) (z - lower)^exponent dz by GSL.
double integrate_gsl(const Function& g, double lower, double upper, double exponent) {
  constexpr std::size_t limit = 200;
  const std::unique_ptr<gsl_integration_workspace, decltype(&gsl_integration_workspace_free)> workspace(
      gsl_integration_workspace_alloc(limit), gsl_integration_workspace_free);
  const std::unique_ptr<gsl_integration_qaws_table, decltype(&gsl_integration_qaws_table_free)> table(
      gsl_integration_qaws_table_alloc(exponent, 0.0, 0, 0), gsl_integration_qaws_table_free);
  gsl_function function{[](double z, void* f) { return (*static_cast<const Function*>(f))(z); },
                        const_cast<Function*>(&g)};
  double result = 0.0, error = 0.0;
  const int status = gsl_integration_qaws(&function, lower, upper, table.get(), 1e-15, tolerance, limit,
                                          workspace.get(), &result, &error);
  // The tolerance may be below what double precision allows; the result is then as good as it gets, within bounds.
  if (status != GSL_SUCCESS && !(error <= 1e-11 * std::abs(result) + 1e-15)) {
    throw std::runtime_error(fmt::format("GSL quadrature of the source failed: {} (estimated error {:.3g} of {:.3g})",
                                         gsl_strerror(status), error, result));
  }
  return result;
}

/// The same by Boost.Math.
double integrate_boost(const Function& g, double lower, double upper, double exponent) {
  thread_local boost::math::quadrature::tanh_sinh<double> rule(12);
  double error = 0.0, scale = 0.0;
  // The second argument is the distance to the nearer end, exact where z - lower would cancel.
  const auto integrand = [&](double z, double to_end) {
    const double from_lower = z - lower < upper - z ? std::abs(to_end) : z - lower;
    return g(lower + from_lower) * std::pow(from_lower, exponent);
  };
  const double result = rule.integrate(integrand, lower, upper, tolerance, &error, &scale);
  if (!(error <= 1e-11 * scale + 1e-15)) {
    throw std::runtime_error(fmt::format("Boost quadrature of the source failed: error estimate {:.3g}", error));
  }
  return result;
}

/// int_0^end g(z) z^exponent dz, between the breaks by `integrate`, which takes the power out of the first piece.
template <class Integrate>
double over_pieces(const std::vector<double>& breaks, double end, const Function& g, double exponent,
                   const Integrate& integrate) {
  const auto bound = [&](std::size_t k) { return k < breaks.size() ? std::min(breaks[k], end) : end; };
  double sum = integrate(g, 0.0, bound(0), exponent);
  const Function powered = [&](double z) { return g(z) * std::pow(z, exponent); };
  for (std::size_t k = 0; k < breaks.size() && breaks[k] < end; ++k)
    sum += integrate(powered, breaks[k], bound(k + 1), 0.0);
  return sum;
}

}  // namespace

double divided_difference(const PointFunction& g, double left, double right, double small) {
  const double gap = right - left;
  if (gap > small) return (g(right).value - g(left).value) / gap;
  const auto slope = [&](double s) { return g(left + 0.5 * (1.0 + s) * gap).slope; };
  return 0.5 * boost::math::quadrature::gauss<double, 20>::integrate(slope, -1.0, 1.0);
}

double nonlocal_terms_adaptively(const Scene& scene, const NonlocalModel& model, SourceRule rule, double x, double t,
                                 std::int64_t& points) {
  const Function G = model.continuum->integrand(scene, model, x, t);
  const double delta = model.delta;
  const double a = model.kernel.origin_exponent;
  const auto integrate = [&](const Function& g, double lower, double upper, double exponent) {
    const Function counted = [&](double z) {
      ++points;
      return g(z);
    };
    return rule == SourceRule::gsl ? integrate_gsl(counted, lower, upper, exponent)
                                   : integrate_boost(counted, lower, upper, exponent);
  };
  const auto weighted = [&](double z) { return G(delta * z) * model.kernel.regular_part(z); };
  return over_pieces(model.kernel.breaks, 1.0, weighted, 1.0 - a, integrate);
}

double kernel_moment_adaptively(const KernelProfile& kernel, int power, double z, SourceRule rule) {
  const auto integrate = rule == SourceRule::gsl ? integrate_gsl : integrate_boost;
  return over_pieces(kernel.breaks, z, kernel.regular_part, power - kernel.origin_exponent, integrate);
}

}  // namespace acstudy
