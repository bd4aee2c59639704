#pragma once

/// @file
/// Arrangements of particles on a line at which operators are studied.

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

/// Where the particles of a run stand at first.
struct Start {
  enum class Kind {
    uniform,    ///< x_j = j h
    jittered,   ///< x_j = (j + r_j) h, r_j random in [-a, a] with a = (1 - smallest_gap)/2; then the closest pair is
                ///< brought to smallest_gap h exactly
    clustered,  ///< the uniform positions moved by a sine: gaps from smallest_gap h at the middle of the period to
                ///< about (2 - smallest_gap) h at its ends
  };
  Kind kind = Kind::uniform;
  double smallest_gap = 1.0;  ///< in units of h, in (0, 1)
  unsigned seed = 1;          ///< of the jitter; equal seeds give equal positions on any machine

  /// "uniform", "jittered(0.01, seed 1)"
  std::string label() const;
  bool operator==(const Start&) const = default;
};

/// The start of `count` particles, increasing, within one period.
std::vector<double> start_positions(const Start& start, std::size_t count, double period);

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
