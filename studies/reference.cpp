#include "studies/reference.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "studies/arrangement.hpp"
#include "studies/operator.hpp"
#include "studies/outcome.hpp"

namespace acstudy {

std::vector<double> interpolate(std::span<const double> x, std::span<const double> u, double period,
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

std::vector<double> values_at(std::span<const double> x, std::span<const double> u, double period,
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
  return values.size() == at.size() ? values : interpolate(x, u, period, at);
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
    std::vector<double> u_0(r.x.size());
    scene.initial(start_positions(series.cases[i].start, r.x.size(), scene.period()), u_0);
    r.u_exact = values_at(reference.x, reference.u, scene.period(), r.x);
    r.solution_linf = std::max(max_norm(u_0), max_norm(r.u_exact));
    const Errors errors = errors_of(scene, r.x, r.u, r.u_exact);
    r.error_linf = errors.linf;
    r.error_l1 = errors.l1;
    r.error_l2 = errors.l2;
  }
}

namespace {

/// The errors of levels whose differences to a reference these are, if errors are of this order.
std::vector<Level> errors_for(double order, std::vector<Level> differences, double reference) {
  for (Level& level : differences) {
    if (order > 0.0 && reference < level.variable) level.error /= 1.0 - std::pow(reference / level.variable, order);
  }
  return differences;
}

}  // namespace

namespace {

constexpr const char* higher_orders =
    "; theorems are upper bounds: if that is right, write order = ... or expect = \"above\" on the path";

}  // namespace

Judgement judge_errors(const std::vector<Level>& levels, const std::optional<ReferenceLevel>& reference,
                       double theory_order, const JudgeOptions& options) {
  if (!reference) {
    Judgement judgement = judge(levels, theory_order, options);
    if (judgement.verdict == Verdict::above) judgement.reason += higher_orders;
    return judgement;
  }
  const auto judged_for = [&](double order) {
    return judge(errors_for(order, levels, reference->variable), theory_order, options);
  };
  double order = theory_order;
  Judgement judgement = judged_for(order);
  if (!meets(judgement.verdict, Verdict::confirmed) && std::isfinite(judgement.order)) {
    // Each round takes the order that the last one has found; the orders approach one another by half and faster.
    constexpr int most = 60;
    constexpr double close = 1e-4;
    double assumed = order;
    Judgement found = judgement;
    for (int round = 0; round < most && found.order > 0.0 && std::abs(found.order - assumed) > close; ++round) {
      assumed = found.order;
      found = judged_for(assumed);
    }
    if (std::abs(found.order - assumed) <= close) {
      order = assumed;
      judgement = found;
      // The order found follows the one that is assumed, so that what is not known of the one adds to the other.
      constexpr double shift = 0.01;
      const double follows = (judged_for(assumed + shift).order - found.order) / shift;
      const double wider = follows > 0.0 && follows < 1.0 ? 1.0 / (1.0 - follows) : 1.0;
      judgement.low = found.order - wider * (found.order - found.low);
      judgement.high = found.order + wider * (found.high - found.order);
    }
  }
  judgement.reason +=
      fmt::format("; differences to the run at N = {}, judged as those of errors of order {:.2f}", reference->N, order);
  return judgement;
}

}  // namespace acstudy
