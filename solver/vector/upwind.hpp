#pragma once

/// @file
/// Model I for several particles at a time; see ModelI.

#include "solver/vector/sweeps.hpp"
#include "solver/vector/walk.hpp"

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
    const Lanes zero = {};
    for (std::ptrdiff_t j = range_.begin; j < range_.end; j += lane_count) {
      const Lanes c_hat = load(sweep_.c_hat + j);
      const Mask counted = counting_from(0.0) < spread(static_cast<double>(range_.end - j));
      const Mask left = c_hat > zero;
      if (all(left)) {
        finish(j, spread(+1.0), sums<+1>(j, left, counted));
      } else if (!any(left)) {
        finish(j, spread(-1.0), sums<-1>(j, ~left, counted));
      } else {
        const UpwindSums l = sums<+1>(j, left, counted), r = sums<-1>(j, ~left, counted);
        finish(j, left ? spread(+1.0) : spread(-1.0),
               {left ? l.W : r.W, left ? l.flux_local : r.flux_local, left ? l.b : r.b,
                left ? l.flux_nonlocal : r.flux_nonlocal});
      }
    }
    return pairs_;
  }

 private:
  template <int s>
  UpwindSums sums(std::ptrdiff_t j, Mask active, Mask counted) {
    UpwindSums sum;
    const int counted_lanes = count(counted);
    const auto visit = [&]<class Kind>(Kind, const Neighbor& neighbor) ACSTUDY_ALWAYS_INLINE {
      const std::ptrdiff_t i = j - s * neighbor.k;
      Lanes W = kernel_.template first_moment<Kind::piece>(neighbor.cell) / neighbor.distance;
      if constexpr (Kind::masked) {
        W = neighbor.active ? W : Lanes{};
        pairs_ += count(neighbor.active & counted);
      } else {
        pairs_ += counted_lanes;
      }
      sum.W += W;
      if constexpr (local) sum.flux_local += W * load(sweep_.local.flux + i);
      if constexpr (nonlocal) {
        sum.b += W * load(sweep_.b + i);
        sum.flux_nonlocal += W * load(sweep_.nonlocal.flux + i);
      }
    };
    walk<s, K>(range_.x + j, {range_.delta, range_.inside}, active, visit);
    const double scale = K::moment_scale;
    return {sum.W * scale, sum.flux_local * scale, sum.b * scale, sum.flux_nonlocal * scale};
  }

  /// (2.9) and (2.11) with the sums taken apart.
  void finish(std::ptrdiff_t j, Lanes s, const UpwindSums& sum) {
    if constexpr (local) {
      const Lanes u = load(sweep_.local.u + j);
      store(sweep_.local.rate + j,
            -load(sweep_.b_prime + j) * u - s * (load(sweep_.c_hat + j) * u * sum.W - sum.flux_local));
    }
    if constexpr (nonlocal) {
      const Lanes u = load(sweep_.nonlocal.u + j);
      store(sweep_.nonlocal.rate + j, -s * ((load(sweep_.c + j) * sum.W - sum.b) * u - sum.flux_nonlocal));
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
      return upwind_with(range, sweep, ScalarLanes(kernel.kernel, kernel.first_moment, kernel.mass));
  }
}

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
