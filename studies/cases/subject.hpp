#pragma once

/// @file
/// What claims of theory are examined on.

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "studies/cases/finding.hpp"
#include "studies/models/arrangement.hpp"
#include "studies/models/field_bounds.hpp"
#include "studies/models/operator.hpp"

namespace acstudy {

/// A scheme on a scene, its particles in one arrangement.
struct Subject {
  SchemeChoice scheme;
  double mu;  ///< viscosity bound, of a viscous model
  std::shared_ptr<const Scene> scene;
  Arrangement arrangement;
  unsigned seeds = 3;  ///< a jittered arrangement is examined with the seeds 1 .. seeds, and the worst counts

  /// The instant of the arrangement: T for particles that have moved, 0 for the others.
  double t() const { return arrangement == Arrangement::moved ? scene->T() : 0.0; }
  /// Every arrangement of N particles that is examined.
  std::vector<std::vector<double>> positions(std::int64_t N) const;
  /// rate_j(u) as the formulas are printed, particles at x.
  PrintedRate printed_rate(const std::vector<double>& x, const std::vector<double>& u, double delta,
                           std::size_t j) const {
    return scheme.model->printed_rate({scheme, *scene, mu, x, u, delta, j});
  }
  /// A check of this subject: its coordinates are the arrangement, the given ones, and those of the scheme, unspoken.
  Check check(std::string statement, std::string claim, const std::vector<Coordinate>& conditions, std::string quantity,
              Test test = Test::bounds) const;
};

/// Numbers of particles and horizons, delta = ratio h with h = period / N, and horizons that stay fixed.
struct Sweep {
  std::vector<std::int64_t> N;
  std::vector<double> ratios, horizons;

  /// The horizons at N particles; those of half the period and more, which no scheme takes, are left out.
  std::vector<double> deltas(std::int64_t N, double period) const;
};

/// Model, kernel, divergence form, viscosity bound and mistake of a scheme as coordinates, unspoken: the label of the
/// scheme says them, but for the viscosity bound.
std::vector<Coordinate> scheme_coordinates(const SchemeChoice& scheme, double mu, bool standing);

/// True if `value` is farther out than `than`. NaN is the worst.
inline bool worse(double value, double than) { return std::isnan(value) || value > than; }

}  // namespace acstudy
