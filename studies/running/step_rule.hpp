#pragma once

/// @file
/// From the start of a case to its end, by its step rule.

#include <algorithm>

#include "solver/time/adaptive.hpp"
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

/// What a run does at each step.
template <class Take, class Error, class TakeBack>
struct StepActions {
  Take take;           ///< take(step) advances the state
  Error error;         ///< error(tolerance) of the step taken, see error_over(); asked of adaptive steps alone
  TakeBack take_back;  ///< take_back() undoes the step taken, and counts it as rejected
};
template <class Take, class Error, class TakeBack>
StepActions(Take, Error, TakeBack) -> StepActions<Take, Error, TakeBack>;

/// Takes steps from 0 to T as the rule of a case has them; see each_step() and each_adaptive_step().
/// @param bound  bound(t): the rule's bound at the particles of time t
template <class Bound, class Actions, class GoesOn>
void step_to_end(const Case& c, Bound&& bound, Actions&& actions, GoesOn&& goes_on) {
  const double T = c.scene->T();
  switch (c.step.bound) {
    case StepRule::Bound::none:
      each_step(EqualSteps(T, c.steps), actions.take, goes_on);
      return;
    case StepRule::Bound::lemma:
    case StepRule::Bound::rows:
      each_step(BoundedSteps(T, [&](double t) { return largest_step(c, t, bound); }), actions.take, goes_on);
      return;
    case StepRule::Bound::tolerance:
      AdaptiveSteps steps(T, c.dt, c.integrator->order);
      each_adaptive_step(
          steps, actions.take, [&] { return actions.error(c.step.tolerance); }, actions.take_back, goes_on);
      return;
  }
}

}  // namespace acstudy
