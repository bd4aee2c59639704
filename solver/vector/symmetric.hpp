#pragma once

/// @file
/// Model II for several particles at a time; see ModelII.

#include "solver/vector/midpoints.hpp"
#include "solver/vector/sweeps.hpp"
#include "solver/vector/walk.hpp"

namespace acstudy {
inline namespace ACSTUDY_ISA {

/// Sums over the neighbors of a particle with m = 2 delta |W|, sign(k) m = 2 delta W: of |d| m, m/|d| and sign(k) b m;
/// of sign(k) c_hat m, and the last two kinds with u of the neighbor.
struct SymmetricSums {
  Lanes moment = {}, slope = {}, b = {}, c_hat = {};
  Lanes c_hat_u_local = {}, slope_u_local = {};
  Lanes c_hat_u_nonlocal = {}, slope_u_nonlocal = {};
};

template <bool local, bool nonlocal, class Midpoints, class K>
class Symmetric {
 public:
  Symmetric(const SweepRange& range, const SymmetricSweep& sweep, K kernel)
      : range_(range), sweep_(sweep), kernel_(kernel) {}

  std::int64_t run() {
    for (std::ptrdiff_t j = range_.begin; j < range_.end; j += lane_count) {
      const Mask counted = counting_from(0.0) < spread(static_cast<double>(range_.end - j));
      const Midpoints midpoints(sweep_, j);
      SymmetricSums sum;
      const Lanes l = add<+1>(j, midpoints, counted, sum), r = add<-1>(j, midpoints, counted, sum);
      finish(j, max(max(l, r), spread(range_.delta)), sum);
    }
    return pairs_;
  }

 private:
  /// Adds what is on the left (s = +1) or right (s = -1). @return distance of the outermost neighbor there
  template <int s>
  Lanes add(std::ptrdiff_t j, const Midpoints& midpoints, Mask counted, SymmetricSums& total) {
    SymmetricSums sum = total;
    const Lanes zero = {};
    const int counted_lanes = count(counted);
    // W < 0 on the left
    const auto add_signed = [](Lanes& to, Lanes value)
                                ACSTUDY_ALWAYS_INLINE { s > 0 ? void(to -= value) : void(to += value); };
    const auto visit = [&]<class Kind>(Kind, const Neighbor& neighbor) ACSTUDY_ALWAYS_INLINE {
      const std::ptrdiff_t i = j - s * neighbor.k;
      Lanes m = kernel_.template mass<Kind::piece>(neighbor.cell);
      if constexpr (Kind::masked) {
        m = neighbor.active ? m : zero;
        pairs_ += count(neighbor.active & counted);
      } else {
        pairs_ += counted_lanes;
      }
      const Lanes slope = m / neighbor.distance;
      sum.moment += neighbor.distance * m;
      sum.slope += slope;
      const Lanes c_hat_m = midpoints.c_hat(i, neighbor.x) * m;
      add_signed(sum.c_hat, c_hat_m);
      if constexpr (local) {
        const Lanes u = load(sweep_.local.u + i);
        add_signed(sum.c_hat_u_local, c_hat_m * u);
        sum.slope_u_local += slope * u;
      }
      if constexpr (nonlocal) {
        const Lanes u = load(sweep_.nonlocal.u + i);
        add_signed(sum.b, midpoints.b(i, neighbor.x) * m);
        add_signed(sum.c_hat_u_nonlocal, c_hat_m * u);
        sum.slope_u_nonlocal += slope * u;
      }
    };
    const Lanes outermost = walk<s, K>(range_.x + j, {range_.delta, range_.inside}, zero == zero, visit);
    total = sum;
    return outermost;
  }

  /// (3.8) and (3.10) with the sums taken apart.
  void finish(std::ptrdiff_t j, Lanes reach, const SymmetricSums& sum) {
    const Lanes per_moment = 1.0 / sum.moment, viscosity = sweep_.mu * reach;
    if constexpr (local) {
      const Lanes u = load(sweep_.local.u + j);
      const Lanes A = sum.c_hat * u + sum.c_hat_u_local, D = sum.slope_u_local - sum.slope * u;
      store(sweep_.local.rate + j, (viscosity * D - A) * per_moment - load(sweep_.b_prime + j) * u);
    }
    if constexpr (nonlocal) {
      const Lanes u = load(sweep_.nonlocal.u + j);
      const Lanes A = sum.c_hat * u + sum.c_hat_u_nonlocal, D = sum.slope_u_nonlocal - sum.slope * u;
      store(sweep_.nonlocal.rate + j, (viscosity * D - A - 2.0 * sum.b * u) * per_moment);
    }
  }

  const SweepRange& range_;
  const SymmetricSweep& sweep_;
  K kernel_;
  std::int64_t pairs_ = 0;
};

template <class Midpoints, class K>
std::int64_t symmetric_with(const SweepRange& range, const SymmetricSweep& sweep, K kernel) {
  const bool local = sweep.local.u != nullptr, nonlocal = sweep.nonlocal.u != nullptr;
  if (local && nonlocal) return Symmetric<true, true, Midpoints, K>(range, sweep, kernel).run();
  if (local) return Symmetric<true, false, Midpoints, K>(range, sweep, kernel).run();
  return Symmetric<false, true, Midpoints, K>(range, sweep, kernel).run();
}

inline std::int64_t symmetric_sweep(const SweepRange& range, const SymmetricSweep& sweep) {
  const SweepKernel& kernel = sweep.kernel;
  const bool polynomial = sweep.panels.terms > 0;
  if (kernel.form != SweepKernel::Form::cubic_spline) {
    const ScalarLanes scalar(kernel.kernel, kernel.first_moment, kernel.mass);
    return polynomial ? symmetric_with<PolynomialMidpoints>(range, sweep, scalar)
                      : symmetric_with<TrigonometricMidpoints<most_modes, most_modes>>(range, sweep, scalar);
  }
  const CubicSplineLanes spline;
  if (polynomial) return symmetric_with<PolynomialMidpoints>(range, sweep, spline);
  // Numbers of modes that are not here take the next larger ones; the rest of their coefficients is zero.
  if (sweep.modes == 0) return symmetric_with<TrigonometricMidpoints<0, 0>>(range, sweep, spline);
  if (sweep.modes == 1) return symmetric_with<TrigonometricMidpoints<1, 1>>(range, sweep, spline);
  if (sweep.modes == 2 && sweep.b_modes <= 1) {
    return symmetric_with<TrigonometricMidpoints<2, 1>>(range, sweep, spline);
  }
  if (sweep.modes == 2) return symmetric_with<TrigonometricMidpoints<2, 2>>(range, sweep, spline);
  return symmetric_with<TrigonometricMidpoints<most_modes, most_modes>>(range, sweep, spline);
}

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
