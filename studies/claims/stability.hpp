#pragma once

/// @file
/// Lemmas 2.4 and 3.3: the exact max norm of a forward Euler step.

#include "studies/cases/measurement.hpp"
#include "studies/cases/subject.hpp"

namespace acstudy {

/// The condition under which a lemma bounds a step.
enum class StepCondition {
  printed,    ///< dt max|c_hat| / h_min <= 1 (Lemma 2.4), 2 dt mu / h_min <= 1 (Lemma 3.3)
  corrected,  ///< dt max_j |c_hat_j| sum_k W_k <= 1, dt mu max_j (reach_j/N_j) sum_k W_k/(x_i - x_j) <= 1: what each
              ///< row needs. Model I's follows from the printed one, Model II's does not
};

/// The largest time step that the condition allows to the particles where they are.
double largest_step(const Subject& subject, PlacedScheme& placed, StepCondition condition);

/// With dt = cfl times that, the max norm of I + dt R is at most 1 + dt (||c_hat'|| + ||b'||), whatever delta; 1 for
/// a constant velocity, the maximum principle.
/// With cfl >= 1.5 and the corrected condition it is not: the negative control.
Measurement step_is_bounded(const Subject& subject, const Sweep& sweep, StepCondition condition, double cfl = 1.0);

/// The printed condition of Lemma 3.3 on gaps h/2, h/2, 3h/2, 3h/2, ... with the horizon just below 2h, where it does
/// not bound the norm.
/// @pre N is a multiple of 4; Model II
Measurement printed_condition_on_uneven_gaps(const Subject& subject, const std::vector<std::int64_t>& N);

}  // namespace acstudy
