#include "mms/quadrature.hpp"

#include <fmt/format.h>
#include <gsl/gsl_integration.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <tuple>

#include "mms/gsl_status.hpp"

namespace acstudy {

namespace {

/// Nodes and weights of int_lower^upper f(z) (z - lower)^exponent dz.
Rule jacobi_rule(double lower, double upper, double exponent, std::size_t points) {
  const std::unique_ptr<gsl_integration_fixed_workspace, decltype(&gsl_integration_fixed_free)> workspace(
      gsl_integration_fixed_alloc(gsl_integration_fixed_jacobi, points, lower, upper, 0.0, exponent),
      gsl_integration_fixed_free);
  const auto failed = [&] {
    return std::domain_error(fmt::format("no Gauss-Jacobi rule for the weight z^{:g} of this kernel", exponent));
  };
  if (workspace == nullptr) throw failed();
  const double* const node = gsl_integration_fixed_nodes(workspace.get());
  const double* const weight = gsl_integration_fixed_weights(workspace.get());
  if (!std::all_of(weight, weight + points, [](double w) { return std::isfinite(w); })) throw failed();
  return {{node, node + points}, {weight, weight + points}};
}

/// The n-point Gauss rule of a measure given by many atoms: Stieltjes' recurrence, then Golub and Welsch.
Rule compress(const Rule& atoms, std::size_t points) {
  const Eigen::Map<const Eigen::ArrayXd> z(atoms.node.data(), atoms.node.size()),
      w(atoms.weight.data(), atoms.weight.size());
  const double mass = w.sum();
  const auto n = static_cast<Eigen::Index>(points);
  Eigen::VectorXd diagonal(n), off_diagonal(n - 1);
  Eigen::ArrayXd previous = Eigen::ArrayXd::Zero(z.size()),
                 p = Eigen::ArrayXd::Constant(z.size(), 1.0 / std::sqrt(mass));
  for (Eigen::Index k = 0; k < n; ++k) {
    diagonal[k] = (w * z * p * p).sum();
    if (k + 1 == n) break;
    Eigen::ArrayXd next = (z - diagonal[k]) * p;
    if (k > 0) next -= off_diagonal[k - 1] * previous;
    off_diagonal[k] = std::sqrt((w * next * next).sum());
    previous = p;
    p = next / off_diagonal[k];
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, off_diagonal);
  Rule rule;
  for (Eigen::Index k = 0; k < n; ++k) {
    rule.node.push_back(solver.eigenvalues()[k]);
    rule.weight.push_back(mass * std::pow(solver.eigenvectors()(0, k), 2));
  }
  return rule;
}

/// Atoms of int_0^1 [ int_0^1 f(theta z) theta^power d theta ] z eta(z) dz, by rules for either integral.
Rule averaged_atoms(const Rule& outer, const Rule& inner) {
  Rule atoms;
  for (std::size_t i = 0; i < outer.size(); ++i) {
    for (std::size_t q = 0; q < inner.size(); ++q) {
      atoms.node.push_back(inner.node[q] * outer.node[i]);
      atoms.weight.push_back(inner.weight[q] * outer.weight[i]);
    }
  }
  return atoms;
}

/// The n-point Gauss rule of these atoms. Rules are cached: a study asks for the same few many times, and each takes
/// milliseconds.
Rule averaged_rule(const KernelProfile& kernel, std::size_t points, double power) {
  static std::mutex mutex;
  static std::map<std::tuple<std::vector<double>, std::vector<double>, std::size_t, double>, Rule> known;
  const std::size_t fine = points + 8;
  const Rule outer = first_moment_rule(kernel, fine);
  const std::tuple key(outer.node, outer.weight, points, power);
  {
    const std::lock_guard lock(mutex);
    if (const auto rule = known.find(key); rule != known.end()) return rule->second;
  }
  const Rule rule = compress(averaged_atoms(outer, jacobi_rule(0.0, 1.0, power, fine)), points);
  const std::lock_guard lock(mutex);
  known.emplace(key, rule);
  return rule;
}

}  // namespace

Rule first_moment_rule(const KernelProfile& kernel, std::size_t points_per_piece) {
  const double a = kernel.origin_exponent;
  const std::vector<double>& breaks = kernel.breaks;
  Rule rule = jacobi_rule(0.0, breaks.empty() ? 1.0 : breaks.front(), 1.0 - a, points_per_piece);
  for (std::size_t i = 0; i < rule.size(); ++i) rule.weight[i] *= kernel.regular_part(rule.node[i]);
  for (std::size_t k = 0; k < breaks.size(); ++k) {
    const Rule rest = jacobi_rule(breaks[k], k + 1 < breaks.size() ? breaks[k + 1] : 1.0, 0.0, points_per_piece);
    for (std::size_t i = 0; i < rest.size(); ++i) {
      rule.node.push_back(rest.node[i]);
      rule.weight.push_back(rest.weight[i] * std::pow(rest.node[i], 1.0 - a) * kernel.regular_part(rest.node[i]));
    }
  }
  return rule;
}

Rule derivative_rule(const KernelProfile& kernel, std::size_t points) { return averaged_rule(kernel, points, 0.0); }

Rule viscous_rule(const KernelProfile& kernel, std::size_t points) { return averaged_rule(kernel, points, 1.0); }

}  // namespace acstudy
