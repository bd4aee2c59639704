#include "studies/running/reference.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "studies/models/arrangement.hpp"
#include "studies/models/operator.hpp"
#include "studies/running/outcome.hpp"

namespace acstudy {

std::vector<double> interpolate_on_line(std::span<const double> x, std::span<const double> u, double period,
                                        std::span<const double> at) {
  constexpr std::ptrdiff_t side = 4;
  constexpr int coefficients = 6;
  const std::ptrdiff_t count = std::ssize(x);
  std::vector<double> values;
  Eigen::Matrix<double, 2 * side, coefficients> powers;
  Eigen::Matrix<double, 2 * side, 1> here, distance;
  for (const double place : at) {
    const double laps = std::floor((place - x.front()) / period), wrapped = place - laps * period;
    const std::ptrdiff_t right = std::upper_bound(x.begin(), x.end(), wrapped) - x.begin();
    for (std::ptrdiff_t k = 0; k < 2 * side; ++k) {
      const std::ptrdiff_t j = right - side + k, lap = (j + 8 * count) / count - 8, i = j - lap * count;
      distance[k] = x[i] - wrapped + static_cast<double>(lap) * period;
      here[k] = u[i];
    }
    distance /= distance.cwiseAbs().maxCoeff();
    powers.col(0).setOnes();
    for (int n = 1; n < coefficients; ++n) powers.col(n) = powers.col(n - 1).cwiseProduct(distance);
    const Eigen::Matrix<double, coefficients, 1> polynomial = powers.colPivHouseholderQr().solve(here);
    values.push_back(polynomial[0]);
  }
  return values;
}

std::vector<double> values_on_line(std::span<const double> x, std::span<const double> u, double period,
                                   std::span<const double> at) {
  // Particles that start at the same place stay together, but for round-off of their trajectories.
  constexpr double together = 1e-12;
  const std::size_t stride = x.size() / at.size();
  std::vector<double> values;
  if (stride * at.size() == x.size()) {
    for (std::size_t j = 0; j < at.size() && std::abs(x[j * stride] - at[j]) <= together * period; ++j) {
      values.push_back(u[j * stride]);
    }
  }
  return values.size() == at.size() ? values : interpolate_on_line(x, u, period, at);
}

void compare_with_reference(const Series& series, std::vector<CaseResult>& results) {
  const auto usable = [](const CaseResult& r) { return r.completed && r.failure.empty() && r.blow_up.empty(); };
  const CaseResult& reference = results.back();
  for (std::size_t i = 0; i < series.levels(); ++i) {
    CaseResult& r = results[i];
    if (!r.completed) continue;
    r.u_exact.clear();
    r.error_linf = r.error_l1 = r.error_l2 = std::numeric_limits<double>::quiet_NaN();
    if (!usable(reference) || !usable(r)) continue;
    const Scene& scene = *series.cases[i].scene;
    const std::span<const double> x = Points(r.x).line();
    std::vector<double> u_0(x.size());
    scene.initial(start_positions(series.cases[i].start, x.size(), scene.period()), u_0);
    r.u_exact = values_on_line(Points(reference.x).line(), reference.u, scene.period(), x);
    r.solution_linf = std::max(max_norm(u_0), max_norm(r.u_exact));
    const Errors errors = errors_of(widths_on_line(x, scene.period()), scene.period(), r.u, r.u_exact);
    r.error_linf = errors.linf;
    r.error_l1 = errors.l1;
    r.error_l2 = errors.l2;
  }
}

}  // namespace acstudy
