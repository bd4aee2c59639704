#pragma once

/// @file
/// What claims of theory are examined on, and the bounds of a scene's fields that enter them.

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "studies/cases/finding.hpp"
#include "studies/models/arrangement.hpp"
#include "studies/models/operator.hpp"

namespace acstudy {

/// A scheme on a scene, its particles in one arrangement.
struct Subject {
  SchemeChoice scheme;
  double mu;  ///< viscosity bound of Model II
  std::shared_ptr<const Scene> scene;
  Arrangement arrangement;
  unsigned seeds = 3;  ///< a jittered arrangement is examined with the seeds 1 .. seeds, and the worst counts

  /// The instant of the arrangement: T for particles that have moved, 0 for the others.
  double t() const { return arrangement == Arrangement::moved ? scene->T() : 0.0; }
  /// Every arrangement of N particles that is examined.
  std::vector<std::vector<double>> positions(std::int64_t N) const;
  /// A check of this subject: its coordinates are the arrangement, the given ones, and those of the scheme, unspoken.
  Check check(std::string statement, std::string claim, const std::vector<Coordinate>& conditions, std::string quantity,
              Test test = Test::bounds) const;
};

/// Numbers of particles and horizons, delta = ratio h with h = period / N, and horizons that stay fixed.
struct Resolutions {
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

/// Max norms over the period at time t, from 4096 samples and their differences, raised by 1/1000: more than that
/// misses of fields with up to 10 waves per period.
struct FieldBounds {
  double c_hat, c_hat_1, c_hat_2;  ///< c - b and its derivatives
  double b_1 = 0.0, b_2 = 0.0;
  double u, u_1, u_2, u_3;
  double flux_2;  ///< second derivative of (c - b) u
};
FieldBounds field_bounds(const Scene& scene, double t);

}  // namespace acstudy
