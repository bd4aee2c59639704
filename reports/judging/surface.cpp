#include "reports/judging/surface.hpp"

#include <fmt/format.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_multifit.h>
#include <gsl/gsl_multifit_nlinear.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <vector>

#include "mms/gsl_status.hpp"

namespace acstudy {

namespace {

/// Parameters of the law. Powers are of h/h_max and delta/delta_max, which makes A and B almost independent of p and q.
enum Parameter : std::size_t { log_A, p, D, log_B, q, F, log_m, parameters };

struct Scaled {
  double h, delta;          ///< relative to the largest
  double log_h, log_delta;  ///< logarithms of these
  double log_error;
};

struct Data {
  std::vector<Scaled> points;
  double h_max = 0.0, delta_max = 0.0;
  std::vector<Parameter> free;  ///< the parameters that are fitted; the others are zero: no corrections, m = 1
};

const std::vector<Parameter> law_parameters = {log_A, p, D, log_B, q, F, log_m}, sum_parameters = {log_A, p, log_B, q};

using Vector = std::array<double, parameters>;

Vector whole(const gsl_vector* x, const Data& data) {
  Vector all{};
  for (std::size_t k = 0; k < data.free.size(); ++k) all[data.free[k]] = gsl_vector_get(x, k);
  return all;
}

/// log a, log b and the law at a point; `share` is the part of a in a^m + b^m.
struct Terms {
  double log_a, log_b, log_law, share;

  Terms(const Vector& x, const Scaled& point)
      : log_a(x[log_A] + x[p] * point.log_h + x[D] * point.h),
        log_b(x[log_B] + x[q] * point.log_delta + x[F] * point.delta) {
    const double m = std::exp(x[log_m]);
    const double larger = std::max(log_a, log_b), gap = std::exp(-m * std::abs(log_a - log_b));
    log_law = larger + std::log1p(gap) / m;
    share = log_a > log_b ? 1.0 / (1.0 + gap) : gap / (1.0 + gap);
  }
};

int residuals(const gsl_vector* x, void* data_, gsl_vector* f) {
  const auto& data = *static_cast<const Data*>(data_);
  const Vector all = whole(x, data);
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    gsl_vector_set(f, i, Terms(all, data.points[i]).log_law - data.points[i].log_error);
  }
  return GSL_SUCCESS;
}

int derivatives(const gsl_vector* x, void* data_, gsl_matrix* J) {
  const auto& data = *static_cast<const Data*>(data_);
  const Vector all = whole(x, data);
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const Scaled& point = data.points[i];
    const Terms at(all, point);
    const double a = at.share, b = 1.0 - at.share;
    const Vector row = {a,
                        a * point.log_h,
                        a * point.h,
                        b,
                        b * point.log_delta,
                        b * point.delta,
                        a * at.log_a + b * at.log_b - at.log_law};
    for (std::size_t k = 0; k < data.free.size(); ++k) gsl_matrix_set(J, i, k, row[data.free[k]]);
  }
  return GSL_SUCCESS;
}

double criterion(double squares, std::size_t points, std::size_t fitted) {
  const auto n = static_cast<double>(points);
  return n * std::log(std::max(squares, std::numeric_limits<double>::min()) / n) +
         static_cast<double>(fitted) * std::log(n);
}

struct Minimum {
  Vector x{}, variance{};
  double squares = 0.0;
};

/// Least squares over some of the parameters.
std::optional<Minimum> minimize(Data& data, const std::vector<Parameter>& free) {
  data.free = free;
  const std::size_t count = free.size();
  double level = 0.0;
  for (const Scaled& point : data.points) {
    level += (point.log_error - std::log(std::max(point.h * data.h_max, point.delta * data.delta_max))) /
             static_cast<double>(data.points.size());
  }
  const Vector start = {
      level + std::log(data.h_max), 1.0, 0.0, level + std::log(data.delta_max), 1.0, 0.0, std::log(4.0)};
  std::vector<double> free_start;
  for (const Parameter k : free) free_start.push_back(start[k]);
  const gsl_vector_const_view from = gsl_vector_const_view_array(free_start.data(), count);

  gsl_multifit_nlinear_fdf problem{};
  problem.f = residuals;
  problem.df = derivatives;
  problem.n = data.points.size();
  problem.p = count;
  problem.params = &data;
  const gsl_multifit_nlinear_parameters options = gsl_multifit_nlinear_default_parameters();
  const std::unique_ptr<gsl_multifit_nlinear_workspace, decltype(&gsl_multifit_nlinear_free)> solver(
      gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &options, problem.n, count), gsl_multifit_nlinear_free);
  if (solver == nullptr || gsl_multifit_nlinear_init(&from.vector, &problem, solver.get()) != GSL_SUCCESS) return {};
  int info = 0;
  const int status = gsl_multifit_nlinear_driver(500, 1e-10, 1e-14, 0.0, nullptr, nullptr, &info, solver.get());
  // GSL_ENOPROG: no step is an improvement any more, as at a minimum that is exact to round-off.
  if (status != GSL_SUCCESS && status != GSL_ENOPROG) return {};

  Minimum minimum;
  const gsl_vector* const f = gsl_multifit_nlinear_residual(solver.get());
  for (std::size_t i = 0; i < problem.n; ++i) minimum.squares += std::pow(gsl_vector_get(f, i), 2);
  const std::unique_ptr<gsl_matrix, decltype(&gsl_matrix_free)> covariance(gsl_matrix_alloc(count, count),
                                                                           gsl_matrix_free);
  gsl_multifit_nlinear_covar(gsl_multifit_nlinear_jac(solver.get()), 0.0, covariance.get());
  for (std::size_t k = 0; k < count; ++k) {
    const double value = gsl_vector_get(gsl_multifit_nlinear_position(solver.get()), k);
    const double variance =
        gsl_matrix_get(covariance.get(), k, k) * minimum.squares / static_cast<double>(problem.n - count);
    if (!std::isfinite(value) || !std::isfinite(variance)) return {};
    minimum.x[free[k]] = value;
    minimum.variance[free[k]] = variance;
  }
  return minimum;
}

/// Sum of squares of log(error) = log C + order log(v) + correction v.
double one_term_squares(const Data& data, double Scaled::*v, double Scaled::*log_v) {
  const std::size_t n = data.points.size();
  std::vector<double> X, y, coefficients(3), covariance(9);
  for (const Scaled& point : data.points) {
    X.insert(X.end(), {1.0, point.*log_v, point.*v});
    y.push_back(point.log_error);
  }
  const gsl_matrix_const_view design = gsl_matrix_const_view_array(X.data(), n, 3);
  const gsl_vector_const_view values = gsl_vector_const_view_array(y.data(), n);
  gsl_vector_view c = gsl_vector_view_array(coefficients.data(), 3);
  gsl_matrix_view cov = gsl_matrix_view_array(covariance.data(), 3, 3);
  const std::unique_ptr<gsl_multifit_linear_workspace, decltype(&gsl_multifit_linear_free)> workspace(
      gsl_multifit_linear_alloc(n, 3), gsl_multifit_linear_free);
  double squares = 0.0;
  gsl_multifit_linear(&design.matrix, &values.vector, &c.vector, &cov.matrix, &squares, workspace.get());
  return squares;
}

}  // namespace

std::optional<SurfaceFit> fit_surface(std::span<const SurfacePoint> points) {
  constexpr std::size_t fewest = 4;
  Data data;
  std::set<double> spacings, horizons;
  for (const SurfacePoint& point : points) {
    for (const double value : {point.h, point.delta, point.error}) {
      if (!(value > 0.0) || !std::isfinite(value)) return {};
    }
    spacings.insert(point.h);
    horizons.insert(point.delta);
  }
  if (spacings.size() < fewest || horizons.size() < fewest) return {};
  data.h_max = *spacings.rbegin();
  data.delta_max = *horizons.rbegin();
  for (const SurfacePoint& point : points) {
    const double h = point.h / data.h_max, delta = point.delta / data.delta_max;
    data.points.push_back({h, delta, std::log(h), std::log(delta), std::log(point.error)});
  }
  const auto law = minimize(data, law_parameters), sum = minimize(data, sum_parameters);
  if (!law) return {};

  const std::size_t n = points.size();
  const auto two_powers = [&](const Minimum& minimum, std::size_t fitted) {
    const double t = gsl_cdf_tdist_Pinv(0.975, static_cast<double>(n - fitted));
    const auto order = [&](Parameter k) {
      const double half_width = t * std::sqrt(minimum.variance[k]);
      return FittedOrder{minimum.x[k], minimum.x[k] - half_width, minimum.x[k] + half_width};
    };
    return TwoPowers{.A = std::exp(minimum.x[log_A]) / std::pow(data.h_max, minimum.x[p]),
                     .B = std::exp(minimum.x[log_B]) / std::pow(data.delta_max, minimum.x[q]),
                     .p = order(p),
                     .q = order(q),
                     .rms = std::sqrt(minimum.squares / static_cast<double>(n)),
                     .bic = criterion(minimum.squares, n, fitted)};
  };
  SurfaceFit fit{two_powers(*law, law_parameters.size())};
  if (sum) fit.sum = two_powers(*sum, sum_parameters.size());
  fit.h_correction = law->x[D];
  fit.delta_correction = law->x[F];
  fit.sharpness = std::exp(law->x[log_m]);
  fit.bic_h = criterion(one_term_squares(data, &Scaled::h, &Scaled::log_h), n, 3);
  fit.bic_delta = criterion(one_term_squares(data, &Scaled::delta, &Scaled::log_delta), n, 3);
  return fit;
}

Judgement judge_surface(std::span<const SurfacePoint> points, double theory_order) {
  Judgement result{};
  result.order = result.low = result.high = result.extrapolated = std::numeric_limits<double>::quiet_NaN();
  const auto conclude = [&](Verdict verdict, std::string reason) {
    result.verdict = verdict;
    result.reason = std::move(reason);
    return result;
  };
  for (const SurfacePoint& point : points) {
    if (!std::isfinite(point.error)) {
      return conclude(Verdict::unstable,
                      fmt::format("the error at h = {:.3g}, delta = {:.3g} is {}", point.h, point.delta, point.error));
    }
  }
  const auto fit = fit_surface(points);
  if (!fit) {
    return conclude(
        Verdict::inconclusive,
        fmt::format("no law in h and delta could be fitted to the {} errors: it takes at least four spacings "
                    "and four horizons, positive errors, and a part of either variable",
                    points.size()));
  }
  constexpr double decisive = 10.0, widest = 0.25;
  const auto distance = [&](const FittedOrder& order) { return std::abs(order.value - theory_order); };
  const FittedOrder& farther = distance(fit->p) > distance(fit->q) ? fit->p : fit->q;
  result.order = farther.value;
  result.low = farther.low;
  result.high = farther.high;
  const std::string orders = fmt::format("order {:.2f} [{:.2f}, {:.2f}] in h and {:.2f} [{:.2f}, {:.2f}] in delta",
                                         fit->p.value, fit->p.low, fit->p.high, fit->q.value, fit->q.low, fit->q.high);
  if (fit->rms > surface_scatter) {
    return conclude(Verdict::inconclusive,
                    fmt::format("no two powers describe the errors: log(error) scatters by {:.2g} "
                                "about the best of them, {}",
                                fit->rms, orders));
  }
  if (std::min(fit->bic_h, fit->bic_delta) - fit->bic < decisive) {
    return conclude(Verdict::inconclusive,
                    fmt::format("the errors depend on {} alone", fit->bic_h < fit->bic_delta ? "h" : "delta"));
  }
  if (std::max(fit->p.high - fit->p.value, fit->q.high - fit->q.value) > widest) {
    return conclude(Verdict::inconclusive, orders + ": the intervals are too wide to judge");
  }
  if (distance(farther) > extrapolation_tolerance) {
    return conclude(farther.value < theory_order ? Verdict::below : Verdict::above,
                    fmt::format("{}, theory says {:g} in both", orders, theory_order));
  }
  return conclude(Verdict::confirmed, fmt::format("{} agree with theory's {:g}; log(error) scatters by {:.2g}, terms "
                                                  "joined with sharpness {:.2g}",
                                                  orders, theory_order, fit->rms, fit->sharpness));
}

}  // namespace acstudy
