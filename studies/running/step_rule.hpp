#pragma once

/// @file
/// From the start of a case to its end, by its step rule.

#include <algorithm>

#include "solver/time/steps.hpp"
#include "studies/cases/case.hpp"

namespace acstudy {

/// The largest step that the step rule of a case allows from t on: by the particles at t and, where later stages see
/// them moved, by those at the end of the step too.
/// @param bound  bound(t): the rule's bound at the particles of time t
template <class Bound>
double largest_step(const Case& c, double t, Bound&& bound) {
  const double now = c.step.safety * bound(t);
  const bool looks_ahead = c.integrator->stage_count() > 1 && !c.integrator->implicit() && !c.scene->standing();
  return looks_ahead ? std::min(now, c.step.safety * bound(std::min(t + now, c.scene->T()))) : now;
}

/// Takes steps from 0 to T as the rule of a case has them; see each_step().
/// @param bound  bound(t): the rule's bound at the particles of time t
template <class Bound, class Take, class GoesOn>
void step_to_end(const Case& c, Bound&& bound, Take&& take, GoesOn&& goes_on) {
  const double T = c.scene->T();
  if (c.step.bound == StepRule::Bound::none) {
    each_step(EqualSteps(T, c.steps), take, goes_on);
  } else {
    each_step(BoundedSteps(T, [&](double t) { return largest_step(c, t, bound); }), take, goes_on);
  }
}

}  // namespace acstudy
