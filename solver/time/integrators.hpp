#pragma once

/// @file
/// Time integrators as tables: explicit strong-stability-preserving Runge-Kutta schemes, and L-stable diagonally
/// implicit ones for stiff scenes, some with an estimate of the error of a step.

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string_view>

namespace acstudy {

inline constexpr std::size_t most_stages = 8;

/// Stage i of a Runge-Kutta scheme in Shu-Osher form, which every explicit and every diagonally implicit one has:
///
///     U_i = sum_{k < i} (alpha_k U_k + beta_k dt F_k) + beta_i dt F_i,   F_k = rate(t^n + c_k dt, U_k),
///
/// where U_0 = u^n, c_0 = 0, and the last stage is u^{n+1}. What is not written is zero. With alpha = {1}, beta is a
/// row of a Butcher tableau.
struct Stage {
  double c;
  std::array<double, most_stages> alpha;
  std::array<double, most_stages + 1> beta;
};

/// A scheme is its table. Where alpha and beta of an explicit one are not negative and beta_k <= alpha_k, every stage
/// is a convex combination of forward Euler steps, so the maximum-norm bounds of Lemmas 2.4 and 3.3 carry over at the
/// same time step. Stages are counted from 1; 0 is the start of the step.
struct Integrator {
  std::string_view name;
  int order;
  std::span<const Stage> stages;
  /// d: dt sum_k d_k F_k, k counted from 0, is by how much u^{n+1} departs from a result that is one order lower, made
  /// of the same rates. It estimates the error of the step; all zero where there is none.
  std::array<double, most_stages + 1> estimate = {};

  bool estimates() const {
    return std::any_of(estimate.begin(), estimate.end(), [](double d) { return d != 0.0; });
  }
  std::size_t stage_count() const { return stages.size(); }
  const Stage& stage(std::size_t i) const { return stages[i - 1]; }
  double c(std::size_t i) const { return i == 0 ? 0.0 : stage(i).c; }
  /// beta_i of stage i; zero where it is explicit.
  double diagonal(std::size_t i) const { return i == 0 ? 0.0 : stage(i).beta[i]; }
  bool implicit() const {
    std::size_t i = 0;
    return std::any_of(stages.begin(), stages.end(), [&](const Stage& s) { return s.beta[++i] != 0.0; });
  }
  /// True if a stage after stage `after` has U_k, or F_k, in its sum.
  bool asks_for_state(std::size_t k, std::size_t after) const {
    const auto later = stages.subspan(after);
    return std::any_of(later.begin(), later.end(), [k](const Stage& s) { return s.alpha[k] != 0.0; });
  }
  bool asks_for_rate(std::size_t k, std::size_t after) const {
    const auto later = stages.subspan(after);
    return std::any_of(later.begin(), later.end(), [k](const Stage& s) { return s.beta[k] != 0.0; });
  }
};

inline constexpr Stage forward_euler_stages[] = {{.c = 1.0, .alpha = {1.0}, .beta = {1.0}}};
inline constexpr Stage ssprk2_stages[] = {{.c = 1.0, .alpha = {1.0}, .beta = {1.0}},
                                          {.c = 1.0, .alpha = {0.5, 0.5}, .beta = {0.0, 0.5}}};
inline constexpr Stage ssprk3_stages[] = {
    {.c = 1.0, .alpha = {1.0}, .beta = {1.0}},
    {.c = 0.5, .alpha = {0.75, 0.25}, .beta = {0.0, 0.25}},
    {.c = 1.0, .alpha = {1.0 - 2.0 / 3.0, 0.0, 2.0 / 3.0}, .beta = {0.0, 0.0, 2.0 / 3.0}}};
inline constexpr Stage backward_euler_stages[] = {{.c = 1.0, .alpha = {1.0}, .beta = {0.0, 1.0}}};
/// 1 - 1/sqrt(2), with which two stages of one diagonal are of second order and L-stable.
inline constexpr double sdirk2_gamma = 0.29289321881345247560;
inline constexpr Stage sdirk2_stages[] = {{.c = sdirk2_gamma, .alpha = {1.0}, .beta = {0.0, sdirk2_gamma}},
                                          {.c = 1.0, .alpha = {1.0}, .beta = {0.0, 1.0 - sdirk2_gamma, sdirk2_gamma}}};

/// Three stages of one diagonal, of third order and L-stable (Alexander 1977): the root of g^3 - 3 g^2 + 3 g/2 - 1/6
/// between 1/6 and 1/2.
inline constexpr double sdirk3_gamma = 0.43586652150845899942;
inline constexpr Stage sdirk3_stages[] = {
    {.c = sdirk3_gamma, .alpha = {1.0}, .beta = {0.0, sdirk3_gamma}},
    {.c = 0.5 * (1.0 + sdirk3_gamma), .alpha = {1.0}, .beta = {0.0, 0.5 * (1.0 - sdirk3_gamma), sdirk3_gamma}},
    {.c = 1.0, .alpha = {1.0}, .beta = {0.0, 1.20849664917601007034, -0.64436317068446906975, sdirk3_gamma}}};

/// The results of lower order are: a forward Euler step in ssprk2, ssprk2 in ssprk3, and in sdirk2 and sdirk3 those of
/// all rates but the last.
inline constexpr Integrator integrators[] = {
    {"forward-euler", 1, forward_euler_stages},
    {"ssprk2", 2, ssprk2_stages, {-0.5, 0.5}},
    {"ssprk3", 3, ssprk3_stages, {-1.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0}},
    {"backward-euler", 1, backward_euler_stages},
    {"sdirk2", 2, sdirk2_stages, {0.0, -sdirk2_gamma, sdirk2_gamma}},
    {"sdirk3", 3, sdirk3_stages, {0.0, sdirk3_gamma, -2.0 * sdirk3_gamma, sdirk3_gamma}},
};

inline constexpr const Integrator& forward_euler = integrators[0];

}  // namespace acstudy
