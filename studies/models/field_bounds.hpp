#pragma once

/// @file
/// Bounds of a scene's fields, of which the constants of theory are made.

#include "mms/scene.hpp"

namespace acstudy {

/// Max norms over the period at time t, from 4096 samples and their differences, raised by 1/1000: more than that
/// misses of fields with up to 10 waves per period.
struct FieldBounds {
  double c_hat, c_hat_1, c_hat_2;  ///< c - b and its derivatives
  double b_1 = 0.0, b_2 = 0.0;
  double u, u_1, u_2, u_3;
  double flux_2;  ///< second derivative of (c - b) u
};
FieldBounds field_bounds(const Scene& scene, double t);

}  // namespace acstudy
