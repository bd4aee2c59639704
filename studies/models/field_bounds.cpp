#include "studies/models/field_bounds.hpp"

#include <vector>

#include "solver/line/particles.hpp"
#include "studies/models/operator.hpp"

namespace acstudy {

FieldBounds field_bounds(const Scene& scene, double t) {
  constexpr std::size_t count = 4096;
  const std::vector<double> x = uniform_positions(count, scene.period());
  const auto derivative = [&](const std::vector<double>& f) {
    std::vector<double> slope(count);
    const double width = 2.0 * scene.period() / count;
    for (std::size_t i = 0; i < count; ++i) slope[i] = (f[(i + 1) % count] - f[(i + count - 1) % count]) / width;
    return slope;
  };
  const auto bound = [](const std::vector<double>& f) { return 1.001 * max_norm(f); };
  std::vector<double> c_hat(count), c_hat_1(count), b(count), b_1(count), u(count), u_1(count), flux_1(count);
  scene.c(x, c_hat, c_hat_1);
  if (!scene.standing()) scene.b(x, b, b_1);
  scene.u(x, t, u, u_1);
  for (std::size_t i = 0; i < count; ++i) {
    c_hat[i] -= b[i];
    c_hat_1[i] -= b_1[i];
    flux_1[i] = c_hat_1[i] * u[i] + c_hat[i] * u_1[i];
  }
  const std::vector<double> u_2 = derivative(u_1);
  return {.c_hat = bound(c_hat),
          .c_hat_1 = bound(c_hat_1),
          .c_hat_2 = bound(derivative(c_hat_1)),
          .b_1 = bound(b_1),
          .b_2 = bound(derivative(b_1)),
          .u = bound(u),
          .u_1 = bound(u_1),
          .u_2 = bound(u_2),
          .u_3 = bound(derivative(u_2)),
          .flux_2 = bound(derivative(flux_1))};
}

}  // namespace acstudy
