#pragma once

/// @file
/// Where steps are stable: norm, growth and spectral radius over CFL number and horizon, and the sharp limits.

#include <string>
#include <vector>

#include "studies/cases/measurement.hpp"
#include "studies/claims/step_operator.hpp"

namespace acstudy {

/// What maps are made over. A CFL number is dt over the bound of the lemma: dt max|c_hat| / h_min (2.4), 2 dt mu /
/// h_min (3.3).
struct StabilityGrid {
  std::int64_t N;
  std::vector<double> ratios;  ///< delta / h
  std::vector<double> cfl;
};

/// What a map shows.
enum class Measure {
  norm,      ///< max norm of one step
  spectral,  ///< spectral radius of one step
  growth,    ///< max norm of the product of all steps to T: of the real ones where particles move
};

const char* quantity_of(Measure measure);

/// Values of a measure at each horizon and CFL number, bounded where theory bounds them. With C = ||c_hat'|| + ||b'||
/// and the integrator's stability function phi, a step grows by at most phi(C dt) while dt is at most
/// `monotonicity_radius` times what the rows need: at any step of backward Euler, where phi(C dt) = 1/(1 - C dt), while
/// C dt < 1.
Measurement stability_map(const Subject& subject, const Integrator& integrator, const StabilityGrid& grid,
                          Measure measure);

/// The largest CFL number, found by bisection, up to which norm or spectral radius of a step keep to phi(C dt), at each
/// horizon. At least what theory promises; exactly what the rows need for forward Euler on uniform standing particles
/// at constant velocity, where the condition
///
///     Model I    c dt sum_k W_k <= 1
///     Model II   dt mu (reach/N_j) sum_k W_k/(x_i - x_j) <= 1   and   mu reach >= |c| |x_i - x_j| for all neighbors
///
/// is necessary as well. If the second part fails, no step is monotone.
/// @param highest  CFL number at which the search ends: the limit is this if it is not below
Measurement sharp_limit(const Subject& subject, const Integrator& integrator, const StabilityGrid& grid,
                        Measure measure, double highest = 1000.0);

/// max |S_n ... S_1| against t at one CFL number and delta = ratio h.
Measurement growth_curve(const Subject& subject, const Integrator& integrator, std::int64_t N, double ratio,
                         double cfl);

/// Smallest entry of a step at each CFL number and horizon: not negative where theory says so.
///
/// Backward Euler: I - dt R is an M-matrix where c_hat keeps its sign while dt ||b'|| < 1 (Model I), or while C dt < 1
/// (Model II). The other integrators: up to `monotonicity_radius` times what the rows need, where c_hat keeps its sign
/// on standing particles (Model I) or is constant (Model II). Of Model I with velocities of both signs the same is
/// demanded, and expected to fail.
Measurement smallest_entry(const Subject& subject, const Integrator& integrator, const StabilityGrid& grid);

}  // namespace acstudy
