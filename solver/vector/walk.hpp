#pragma once

/// @file
/// The walk of consecutive particles over their neighbors on one side, all of them in step.

#include "solver/vector/kernels.hpp"
#include "solver/vector/lanes.hpp"

namespace acstudy {
inline namespace ACSTUDY_ISA {

/// Which neighbors are inside: up to `inside`, delta plus the tolerance of ties.
struct Horizon {
  double delta, inside;
};

/// What a visit finds at the neighbor k of every lane.
struct Neighbor {
  std::ptrdiff_t k;
  Lanes x;
  Lanes distance;
  CellLanes cell;
  Mask active;  ///< only where some lanes are through with their window
};

template <Piece p, bool m>
struct VisitKind {
  static constexpr Piece piece = p;
  static constexpr bool masked = m;
};

/// Calls visit(VisitKind, Neighbor) for k = 1, 2, ... until every active lane has left its window.
///
/// Neighbor k of lane l is x[l - s k]. While no lane leaves its window and all cells are within one piece of the
/// kernel, nothing is masked and no case is told from another: one comparison a neighbor finds out.
///
/// @param x       at the first of the particles, readable as far as the windows reach and one beyond
/// @param active  the lanes that look to this side
/// @return        distance of the outermost neighbor of each active lane
template <int s, class K, class Visit>
ACSTUDY_ALWAYS_INLINE inline Lanes walk(const double* x, Horizon horizon, Mask active, Visit&& visit) {
  const double per_delta = 1.0 / horizon.delta;
  const Lanes x_0 = load(x), delta = spread(horizon.delta), inside = spread(horizon.inside);
  std::ptrdiff_t k = 1;
  Lanes before = x_0, here = load(x - s);
  Lanes distance = s > 0 ? x_0 - here : here - x_0;
  Lanes z_before = {}, rest_before = spread(1.0);

  const auto next_neighbor = [&]() ACSTUDY_ALWAYS_INLINE { return load(x - s * (k + 1)); };
  const auto distance_of = [&](Lanes neighbor)
                               ACSTUDY_ALWAYS_INLINE { return s > 0 ? x_0 - neighbor : neighbor - x_0; };
  const auto gap = [&]() ACSTUDY_ALWAYS_INLINE { return s > 0 ? before - here : here - before; };
  const auto step_to = [&](Lanes neighbor, Lanes its_distance, const CellLanes& cell) ACSTUDY_ALWAYS_INLINE {
    before = here;
    here = neighbor;
    distance = its_distance;
    z_before = cell.outer;
    rest_before = cell.rest_outer;
    ++k;
  };
  // Neighbors with the next one within `limit`, up to the first whose cell begins at `until` or beyond it.
  const auto unmasked = [&]<Piece piece>(Lanes limit, double until) ACSTUDY_ALWAYS_INLINE {
    for (;;) {
      if (until > 0.0 && all_at_most(spread(until), z_before)) return;
      const Lanes next = next_neighbor(), next_distance = distance_of(next);
      if (!all_at_most(next_distance, limit)) return;
      const CellLanes cell{z_before, distance * per_delta, gap() * per_delta, rest_before,
                           (delta - distance) * per_delta};
      visit(VisitKind<piece, false>{}, Neighbor{k, here, distance, cell, active});
      step_to(next, next_distance, cell);
    }
  };

  if (all(active)) {
    if constexpr (K::breakpoint < 1.0) {
      unmasked.template operator()<Piece::inside>(delta * K::breakpoint, 0.0);
      unmasked.template operator()<Piece::any>(inside, K::breakpoint);
      unmasked.template operator()<Piece::outside>(inside, 0.0);
    } else {
      unmasked.template operator()<Piece::any>(inside, 0.0);
    }
  }

  Lanes outermost = {};
  const auto masked = [&]<Piece piece>() ACSTUDY_ALWAYS_INLINE {
    while (any(active)) {
      const Lanes next = next_neighbor(), next_distance = distance_of(next);
      const Mask goes_on = active & (next_distance <= inside);
      CellLanes cell;
      cell.inner = z_before;
      cell.rest_inner = rest_before;
      cell.outer = goes_on ? min(distance * per_delta, spread(1.0)) : spread(1.0);
      cell.rest_outer = goes_on ? max((delta - distance) * per_delta, Lanes{}) : Lanes{};
      // The last cell ends at the horizon, beyond which a neighbor that ties with it may stand.
      cell.width = goes_on ? min(gap() * per_delta, rest_before) : rest_before;
      visit(VisitKind<piece, true>{}, Neighbor{k, here, distance, cell, active});
      outermost = active ? distance : outermost;
      active = goes_on;
      step_to(next, next_distance, cell);
    }
  };
  if (K::breakpoint < 1.0 && all_at_most(spread(K::breakpoint), z_before)) {
    masked.template operator()<Piece::outside>();
  } else {
    masked.template operator()<Piece::any>();
  }
  return outermost;
}

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
