#pragma once

/// @file
/// A scheme of one's own: Model I with cells that end at the midpoints between neighbors, renormalized.

#include <cmath>

#include "studies/models/own_scheme.hpp"

/// With neighbors i = j + s k at distances d_k on the side s that the flow comes from, and W_k = m_k / d_k, where m_k is
/// the first moment of the kernel from the midpoint before neighbor k to that behind it, of the last one to the horizon:
///
///     du_j/dt = -b'_j u_j - sum_k |c_hat|_j u_j W_k + sum_k |c_hat|_i u_i W_k,     sum_k d_k W_k = 1
struct RenormalizedUpwind {
  template <class Add>
  static void rate(const acstudy::OneParticle& p, Add add) {
    const int side = p.c_hat() > 0.0 ? -1 : +1, count = side < 0 ? p.left() : p.right();
    double before = 0.0;
    for (int k = 1; k <= count; ++k) {
      const double d = std::abs(p.z(side * k));
      const double moment = k < count ? p.first_moment(0.5 * (d + std::abs(p.z(side * (k + 1))))) : 1.0;
      const double W = (moment - before) / d;
      add(0, side * p.c_hat() * W);
      add(side * k, -side * p.c_hat(side * k) * W);
      before = moment;
    }
    add(0, -p.b_prime());
  }
};

// First order in max(h, delta); forward Euler is monotone up to dt = h_min / max|c - b|, as sum_k W_k <= 1/h_min.
inline const acstudy::OwnScheme<RenormalizedUpwind> renormalized_upwind{
    {.name = "renormalized-upwind", .order = 1.0, .speed = 1.0}};
