#include "studies/running/outcome.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "studies/models/operator.hpp"

namespace acstudy {

std::vector<double> widths_on_line(std::span<const double> x, double period) {
  const std::size_t count = x.size();
  std::vector<double> widths(count);
  for (std::size_t j = 0; j < count; ++j) {
    const double right = j + 1 < count ? x[j + 1] : x[0] + period;
    const double left = j > 0 ? x[j - 1] : x[count - 1] - period;
    widths[j] = 0.5 * (right - left);
  }
  return widths;
}

Errors errors_of(std::span<const double> volumes, double whole, std::span<const double> u,
                 std::span<const double> u_exact) {
  Errors errors;
  for (std::size_t j = 0; j < u.size(); ++j) {
    const double error = std::abs(u[j] - u_exact[j]);
    // Once NaN, it stays: no comparison with a NaN is true.
    if (std::isnan(error) || error > errors.linf) errors.linf = error;
    errors.l1 += volumes[j] * error;
    errors.l2 = std::hypot(errors.l2, std::sqrt(volumes[j]) * error);  // a square of an error may overflow
  }
  errors.l1 /= whole;
  errors.l2 /= std::sqrt(whole);
  return errors;
}

namespace {

/// The first field of the scene that is not finite at a particle at time t, with its place; empty if there is none.
std::string field_at_fault(const Scene& scene, const Points& x, double t) {
  const std::size_t d = x.dimension();
  PointArray vectors;
  vectors.resize(x.size(), d);
  std::vector<double> value(x.size()), by_t(x.size());
  std::string found;
  const auto look = [&](const char* what, std::span<const double> values) {
    for (std::size_t i = 0; i < values.size() && found.empty(); ++i) {
      if (std::isfinite(values[i])) continue;
      const std::size_t j = i % x.size();
      found = fmt::format(
          "{} is {} at {}, t = {:.6g}, where particle {} is; a field must be finite, and have finite derivatives, "
          "wherever particles come",
          what, std::isnan(values[i]) ? std::abs(values[i]) : values[i], place_of(x, j), t, j);
    }
  };
  scene.c(x, vectors, value);
  look("c", vectors.coordinates);
  look("the derivative of c", value);
  if (!scene.standing()) {
    scene.b(x, vectors, value);
    look("b", vectors.coordinates);
    look("the derivative of b", value);
  }
  if (scene.solved()) {
    scene.u(x, t, value, vectors, by_t);
    look("u", value);
    look("the derivative of u by x", vectors.coordinates);
    look("the derivative of u by t", by_t);
  } else if (!scene.sourceless()) {
    scene.f(x, t, value);
    look("f", value);
  }
  return found;
}

}  // namespace

std::string failure_in_step(const std::domain_error& error, const CaseResult& result, double t) {
  return fmt::format("{} in step {}, from t = {:.6g} on", error.what(), result.steps + 1, t);
}

void conclude(CaseResult& result, const Case& c, const GrowthWatch& growth, std::span<const double> u, double t,
              double solution_at_first, const std::function<Points(double)>& positions, const Volumes& volumes) {
  const Scene& scene = *c.scene;
  result.blow_up = growth.blow_up();
  const bool to_the_end = result.failure.empty() && result.blow_up.empty();
  result.last = growth.last();
  const double end = to_the_end ? scene.T() : result.blow_up.empty() ? t : result.last.time;
  const Points x = positions(end);
  result.x.assign(x);
  result.u.assign(u.begin(), u.end());
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  Errors errors{unknown, unknown, unknown};
  if (scene.solved()) {
    result.u_exact.resize(u.size());
    scene.u(x, end, result.u_exact);
    errors = errors_of(volumes(x), scene.volume(), result.u, result.u_exact);
  }
  result.solution_linf = std::max(solution_at_first, max_norm(result.u_exact));
  if (to_the_end) {
    result.error_linf = errors.linf;
    result.error_l1 = errors.l1;
    result.error_l2 = errors.l2;
    if (scene.solved() && !std::isfinite(errors.linf)) result.blow_up = "the error is not finite at T";
  } else {
    result.error_linf = result.error_l1 = result.error_l2 = unknown;
    result.last.error_linf = errors.linf;
    result.last.error_l1 = errors.l1;
    result.last.error_l2 = errors.l2;
    result.last.step = result.blow_up.empty() ? result.steps : result.last.step;
    result.last.time = end;
    if (result.last.particle >= 0) result.last.place = x[0][static_cast<std::size_t>(result.last.particle)];
  }
  if (result.blow_up.empty()) return;
  // A scene whose fields are not finite is no fault of the scheme: look at the stages of the last step.
  const double from = std::isnan(result.last.time) ? t : result.last.time;
  std::string fault = field_at_fault(scene, positions(t), t);
  for (std::size_t k = 0; k < c.integrator->stage_count() && fault.empty(); ++k) {
    const double at = TimeStep{.begin = from, .end = t, .dt = t - from}.at(c.integrator->c(k));
    fault = field_at_fault(scene, positions(at), at);
  }
  if (fault.empty()) return;
  result.failure = fault;
  result.blow_up.clear();
}

}  // namespace acstudy
