#pragma once

/// @file
/// Arrangements of particles at which operators are studied.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "mms/scene.hpp"

namespace acstudy {

enum class Arrangement {
  uniform,   ///< x_j = j h
  moved,     ///< the uniform start carried by the scene's flow to T
  jittered,  ///< x_j = (j + r_j) h, r_j random in [-1/4, 1/4], reproducible: gaps from h/2 to 3h/2
};
inline constexpr std::array arrangements = {Arrangement::uniform, Arrangement::moved, Arrangement::jittered};

std::string_view name_of(Arrangement arrangement);

/// Positions of `count` particles, increasing, within one period.
/// @param seed  of the jitter; equal seeds give equal positions on any machine
/// @pre  !scene.standing() for `moved`
std::vector<double> arrange(Arrangement arrangement, const Scene& scene, std::size_t count, unsigned seed = 1);

/// The largest and smallest gap between neighbors, the one across the period included.
struct Gaps {
  double largest, smallest;
};
Gaps gaps(const std::vector<double>& x, double period);

}  // namespace acstudy
