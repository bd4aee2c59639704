#pragma once

/// @file
/// What a scheme asks of the velocity fields, and the treatments of the divergence b'(x) u.

#include <concepts>
#include <cstdint>
#include <span>

namespace acstudy {

/// Role of a velocity: fills `out[i]` with the field at `x[i]`; whole arrays at once, so that a field given by an
/// expression costs one call a sweep and not one a pair.
template <class V>
concept AdvectionVelocity = requires(const V v, std::span<const double> x, std::span<double> out) {
  v.c(x, out);
};

/// A velocity with a particle motion x' = b(x).
template <class V>
concept ParticleVelocity = AdvectionVelocity<V> &&
    requires(const V v, std::span<const double> x, std::span<double> out) {
  v.b(x, out);
  v.b_prime(x, out);
};

/// Particles stand still, b = 0: the relative velocity is c and there is no divergence term. (2.4), (3.6)
struct NoDivergence {};
/// Scheme 1: b'(x) u with the exact derivative. (2.9), (3.8)
struct LocalDivergence {};
/// Scheme 2: b'(x) u relaxed nonlocally by the kernel of the model. (2.11), (3.10)
struct NonlocalDivergence {};

/// What a scheme has done so far.
struct WorkCounts {
  std::int64_t pairs = 0;                 ///< pair interactions summed in rates
  std::int64_t weight_builds = 0;         ///< times the weights of all particles were computed
  std::int64_t velocity_evaluations = 0;  ///< point values of c, b or b'
};

}  // namespace acstudy
