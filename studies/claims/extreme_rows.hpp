#pragma once

/// @file
/// What the rows of the table of extremes are made of: scenes, runs without source, and the list itself.

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "solver/time/steps.hpp"
#include "studies/cases/measurement.hpp"
#include "studies/cases/subject.hpp"
#include "studies/claims/extremes.hpp"
#include "studies/running/run_case.hpp"

namespace acstudy {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// The list of measurements.
class ExtremeRows {
 public:
  /// @param measure  gives a finding its points
  void add(Check check, std::function<void(Finding&)> measure);
  /// The same as a negative control; `why` it must fail. One that is there already is not added again: the schemes of
  /// both divergences have the same mistakes.
  void add_control(Check check, const std::string& why, std::function<void(Finding&)> measure,
                   Verdict expected = Verdict::violated);

  std::vector<Measurement> take() { return std::move(measurements_); }

 private:
  std::set<std::string> controls_;
  std::vector<Measurement> measurements_;
};

void add_rows_of_resolution(ExtremeRows& rows, const Extremes& extremes);  ///< N, delta/h, alpha
void add_rows_of_velocity(ExtremeRows& rows, const Extremes& extremes);    ///< c = 0, c constant, b = c, zeros of c_hat
void add_rows_of_positions(ExtremeRows& rows, const Extremes& extremes);   ///< coincident particles
void add_rows_of_amplitude(ExtremeRows& rows, const Extremes& extremes);   ///< u times 1e300 and 1e-300
void add_rows_of_time(ExtremeRows& rows, const Extremes& extremes);    ///< T = 0, one step, 10^6 steps, CFL beyond 1
void add_rows_of_shapes(ExtremeRows& rows, const Extremes& extremes);  ///< square wave and hat
void add_rows_of_mass(ExtremeRows& rows, const Extremes& extremes);    ///< mass drift

/// A scene of the period 1, or the named one.
std::shared_ptr<const Scene> scene_with(const std::string& c, const std::optional<std::string>& b = std::nullopt,
                                        const std::string& u = "sin(2*pi*(x - t))");
std::shared_ptr<const Scene> scene_named(std::string_view name);

/// "c = sin(2*pi*x)"
inline Coordinate velocity_is(const std::string& c) { return {"c", c, "c = " + c}; }
/// "scene lagrangian"
inline Coordinate on_scene(const std::string& name) { return {"scene", name, "scene " + name}; }

/// A scheme on a scene, with the viscosity bound of the scene if its model is viscous.
Subject subject_on(const SchemeChoice& scheme, const std::shared_ptr<const Scene>& scene,
                   Arrangement arrangement = Arrangement::uniform);
/// The same with a control's mistake, made with the local divergence; nothing where a card names no such mistake.
std::optional<Subject> mistaken(Subject subject, std::string_view control);

/// The schemes, each once, where particles stand still and the divergence is of no matter.
std::vector<SchemeChoice> standing_schemes(const Extremes& extremes);

/// Round-off of a sum over the neighbors of a particle whose terms sum to one: an ulp per neighbor and eight more.
inline double row_round_off(const Particles& particles) { return (2.0 * particles.windows.widest + 8.0) * epsilon; }
/// Round-off of a forward Euler step within CFL 1, relative to max |u|.
inline double step_round_off(const Subject& subject, const Particles& particles) {
  return subject.scheme.model->row_terms * row_round_off(particles);
}

/// The largest step of the scheme itself, also for one with a mistake: `StepLemma::row_by_row`.
double step_at_cfl_one(Subject subject, const std::vector<double>& x, double delta);

/// Particles at a final time.
struct State {
  std::vector<double> x, u;
};

/// What is looked at after each step: the step, positions and values at its end.
using Seen = std::function<void(const TimeStep&, std::span<const double> x, std::span<const double> u)>;

/// A run by forward Euler without source, whose particles follow the scene's flow if it has one.
State run_freely(const Subject& subject, State start, double delta, double T, std::int64_t steps,
                 const Seen& seen = {});

/// The case of a subject on the uniform start, its source that of the PDE, in `steps` equal steps to the scene's T.
Case case_of(const Subject& subject, std::int64_t N, double delta, std::int64_t steps,
             std::string_view integrator = "forward-euler");
/// @throws std::runtime_error if the run has failed
CaseResult run(const Case& c);

/// max(v_j - largest, smallest - v_j): how far values leave an interval; NaN if one is.
double excursion(std::span<const double> values, double smallest, double largest);

/// Values in [0, 1] in no order, 0 and 1 among them.
std::vector<double> uneven_values(std::size_t count);

/// u_0 at the positions x.
template <class F>
std::vector<double> values_at(const std::vector<double>& x, F&& u_0) {
  std::vector<double> u;
  for (const double position : x) u.push_back(u_0(position));
  return u;
}

/// 1 where `action` throws E with a message that contains `text`, 0 where it throws nothing.
template <class E, class Action>
double refused(Action&& action, std::string_view text) {
  try {
    action();
  } catch (const E& error) {
    return std::string_view(error.what()).find(text) != std::string_view::npos ? 1.0 : 0.5;
  }
  return 0.0;
}

}  // namespace acstudy
