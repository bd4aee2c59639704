#pragma once

/// @file
/// Controls: velocity fields with one of them forgotten, for schemes that are right themselves.

#include <algorithm>
#include <span>

#include "solver/velocity.hpp"

namespace acstudy::controls {

/// b' = 0: the term b' u of the local divergence is missing.
template <ParticleVelocity V>
struct NoDivergenceTerm {
  const V& velocity;
  void c(std::span<const double> x, std::span<double> out) const { velocity.c(x, out); }
  void b(std::span<const double> x, std::span<double> out) const { velocity.b(x, out); }
  void b_prime(std::span<const double>, std::span<double> out) const { std::fill(out.begin(), out.end(), 0.0); }
};

/// b = 0: with the local divergence, c in the place of c - b.
template <ParticleVelocity V>
struct AbsoluteVelocity {
  const V& velocity;
  void c(std::span<const double> x, std::span<double> out) const { velocity.c(x, out); }
  void b(std::span<const double>, std::span<double> out) const { std::fill(out.begin(), out.end(), 0.0); }
  void b_prime(std::span<const double> x, std::span<double> out) const { velocity.b_prime(x, out); }
};

}  // namespace acstudy::controls
