#pragma once

/// @file
/// Controls: velocity fields with one of them forgotten, for schemes that are right themselves.

#include <algorithm>
#include <span>

#include "solver/velocity.hpp"

namespace acstudy::controls {

enum class Forgotten {
  nothing,
  divergence_term,    ///< b' = 0: the term b' u of the local divergence is missing
  particle_velocity,  ///< b = 0: with the local divergence, c in the place of c - b
};

/// The velocity V but for what is forgotten of it.
template <ParticleVelocity V>
struct ForgetfulVelocity {
  const V& velocity;
  Forgotten forgotten = Forgotten::nothing;

  void c(std::span<const double> x, std::span<double> out) const { velocity.c(x, out); }
  void b(std::span<const double> x, std::span<double> out) const {
    forgotten == Forgotten::particle_velocity ? std::fill(out.begin(), out.end(), 0.0) : velocity.b(x, out);
  }
  void b_prime(std::span<const double> x, std::span<double> out) const {
    forgotten == Forgotten::divergence_term ? std::fill(out.begin(), out.end(), 0.0) : velocity.b_prime(x, out);
  }
};

}  // namespace acstudy::controls
