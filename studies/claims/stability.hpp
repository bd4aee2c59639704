#pragma once

/// @file
/// Lemmas 2.4 and 3.3: the exact max norm of a forward Euler step.

#include "studies/claims/subject.hpp"

namespace acstudy {

/// The condition under which a lemma bounds a step.
enum class StepCondition {
  printed,    ///< dt max|c_hat| / h_min <= 1 (Lemma 2.4), 2 dt mu / h_min <= 1 (Lemma 3.3)
  corrected,  ///< dt mu max_j (reach_j/N_j) sum_k W_k/(x_i - x_j) <= 1, Model II; of Model I, the printed one
};

/// The largest time step that the condition allows to the particles where they are.
double largest_step(const Subject& subject, PlacedScheme& placed, StepCondition condition);

/// With dt = cfl times that, the max norm of I + dt R is at most 1 + dt (||c_hat'|| + ||b'||), whatever delta; 1 for
/// a constant velocity, the maximum principle.
Finding step_is_bounded(const Subject& subject, const Sweep& sweep, StepCondition condition, double cfl = 1.0);

}  // namespace acstudy
