#pragma once

/// @file
/// Model I for several particles at a time; see ModelI.

#include "solver/line/vector/sweeps.hpp"
#include "solver/line/vector/walk.hpp"

namespace acstudy {
inline namespace ACSTUDY_ISA {

/// Sums over the neighbors of a particle: of W, W c_hat u and W b.
struct UpwindSums {
  Lanes W = {}, flux_local = {}, b = {}, flux_nonlocal = {};
};

template <bool local, bool nonlocal, class K>
class Upwind {
 public:
  Upwind(const SweepRange& range, const UpwindSweep& sweep, K kernel) : range_(range), sweep_(sweep), kernel_(kernel) {}

  std::int64_t run() {
    const Lanes inside = spread(range_.inside), none = spread(-1.0);
    for (std::ptrdiff_t j = range_.begin; j < range_.end; j += lane_count) {
      const unsigned counted = first_lanes(range_.end - j);
      const Choice looks_right = at_most(load(sweep_.c_hat + j), Lanes{});
      const unsigned right = bits(looks_right);
      if (right == 0) {
        finish(j, spread(+1.0), sums<+1>(j, inside, counted));
      } else if (right == all_bits) {
        finish(j, spread(-1.0), sums<-1>(j, inside, counted));
      } else {
        const UpwindSums l = sums<+1>(j, select(looks_right, none, inside), counted & ~right),
                         r = sums<-1>(j, select(looks_right, inside, none), counted & right);
        finish(j, select(looks_right, spread(-1.0), spread(+1.0)),
               {select(looks_right, r.W, l.W), select(looks_right, r.flux_local, l.flux_local),
                select(looks_right, r.b, l.b), select(looks_right, r.flux_nonlocal, l.flux_nonlocal)});
      }
    }
    return pairs_;
  }

 private:
  /// @param inside   negative for lanes that look to the other side
  /// @param counted  lanes whose pairs are counted
  template <int s>
  UpwindSums sums(std::ptrdiff_t j, Lanes inside, unsigned counted) {
    const Viewpoint from{load(range_.x + j), inside, range_.delta, 1.0 / range_.delta};
    Side<s, K> side(range_.x + j, from, counted, kernel_);
    UpwindSums sum;
    const auto first_moment = [&]<KernelPiece piece>(Lanes z)
                                  ACSTUDY_ALWAYS_INLINE { return kernel_.template first_moment<piece>(z); };
    std::int64_t pairs = 0;
    const auto add = [&]<KernelPiece piece>(Side<s, K>& there) ACSTUDY_ALWAYS_INLINE {
      pairs += there.count();
      const Neighbor neighbor = there.neighbor();
      const Lanes W = there.template step<piece>(first_moment) / neighbor.distance;
      const std::ptrdiff_t i = j - s * neighbor.k;
      sum.W += W;
      if constexpr (local) sum.flux_local += W * load(sweep_.local.flux + i);
      if constexpr (nonlocal) {
        sum.b += W * load(sweep_.b + i);
        sum.flux_nonlocal += W * load(sweep_.nonlocal.flux + i);
      }
    };
    walk<K>(add, side);
    pairs_ += pairs;
    return sum;
  }

  /// (2.9) and (2.11) with the sums taken apart.
  void finish(std::ptrdiff_t j, Lanes s, const UpwindSums& sum) {
    const Lanes scale = s * K::moment_scale;
    if constexpr (local) {
      const Lanes u = load(sweep_.local.u + j);
      store(sweep_.local.rate + j,
            -load(sweep_.b_prime + j) * u - scale * (load(sweep_.c_hat + j) * u * sum.W - sum.flux_local));
    }
    if constexpr (nonlocal) {
      const Lanes u = load(sweep_.nonlocal.u + j);
      store(sweep_.nonlocal.rate + j, -scale * ((load(sweep_.c + j) * sum.W - sum.b) * u - sum.flux_nonlocal));
    }
  }

  const SweepRange& range_;
  const UpwindSweep& sweep_;
  K kernel_;
  std::int64_t pairs_ = 0;
};

template <class K>
std::int64_t upwind_with(const SweepRange& range, const UpwindSweep& sweep, K kernel) {
  const bool local = sweep.local.u != nullptr, nonlocal = sweep.nonlocal.u != nullptr;
  if (local && nonlocal) return Upwind<true, true, K>(range, sweep, kernel).run();
  if (local) return Upwind<true, false, K>(range, sweep, kernel).run();
  return Upwind<false, true, K>(range, sweep, kernel).run();
}

inline std::int64_t upwind_sweep(const SweepRange& range, const UpwindSweep& sweep) {
  const SweepKernel& kernel = sweep.kernel;
  switch (kernel.form) {
    case SweepKernel::Form::inverse:
      return upwind_with(range, sweep, InverseLanes{});
    case SweepKernel::Form::cubic_spline:
      return upwind_with(range, sweep, CubicSplineLanes{});
    default:
      return upwind_with(range, sweep, TableLanes(kernel));
  }
}

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
