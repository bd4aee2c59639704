#pragma once

/// @file
/// What a scheme has to offer.

#include <concepts>
#include <cstddef>
#include <span>

#include "solver/line/particles.hpp"
#include "solver/rate_matrix.hpp"
#include "solver/velocity.hpp"

namespace acstudy {

namespace archetypes {

/// A velocity and nothing else, to check requirements with.
struct Velocity {
  void c(std::span<const double>, std::span<double>) const {}
  void b(std::span<const double>, std::span<double>) const {}
  void b_prime(std::span<const double>, std::span<double>) const {}
};

}  // namespace archetypes

/// One that sees its neighbors on one side: which side, and W_1 .. W_L of particle j, nearest first.
template <class S>
concept SeesOneSide = requires(const S placed, std::ptrdiff_t j) {
  { placed.looks_left(j) } -> std::same_as<bool>;
};

/// One that sees both sides: N_j, and W_k, k = -l_j .. -1, 1 .. r_j, of particle j.
template <class S>
concept SeesBothSides = requires(const S placed, std::ptrdiff_t j) {
  { placed.renormalization(j) } -> std::same_as<double>;
};

template <class S>
concept KnowsItsSides = SeesOneSide<S> || SeesBothSides<S>;

/// Role of a sum over neighbors: rates du_j/dt = rate_j(u), without the source. Mistakes made on purpose are no more.
///
/// | expression              | meaning                                                                       |
/// |-------------------------|-------------------------------------------------------------------------------|
/// | `s.place(particles, v)` | takes velocities and weights for the particles where they are now             |
/// | `s.rate(u, du)`         | du_j = rate_j(u), after place(); may wrap the ghosts of `u`                   |
/// | `s.weights(j)`          | W_k of particle j, after place()                                              |
/// | `s.looks_left(j)`       | or `s.renormalization(j)`: on which sides its neighbors are, see above        |
/// | `s.work()`              | what it has done so far                                                       |
template <class S>
concept RateSum = KnowsItsSides<S> &&
    requires(S s, const S placed, const Particles& particles, const archetypes::Velocity& v, PeriodicArray& u,
             std::span<double> du, std::ptrdiff_t j) {
  s.place(particles, v);
  s.rate(u, du);
  { *placed.weights(j).begin() } -> std::convertible_to<double>;
  { placed.work() } -> std::convertible_to<WorkCounts>;
};

/// What implicit integrators, steps that follow the rows, and studies of stability ask besides, of its rows.
///
/// | expression            | meaning, after place()                                                         |
/// |-----------------------|--------------------------------------------------------------------------------|
/// | `s.matrix(R)`         | R becomes the matrix of the rates: rate(u) = R u to round-off                  |
/// | `s.strongest_decay()` | one over the largest step of forward Euler that the proof of stability allows  |
template <class S>
concept KnowsItsRows = requires(const S placed, RateMatrix& R) {
  placed.matrix(R);
  { placed.strongest_decay() } -> std::same_as<double>;
};

/// Role of a semidiscrete scheme. Models: ModelI, ModelII.
template <class S>
concept Scheme = RateSum<S> && KnowsItsRows<S>;

}  // namespace acstudy
