#pragma once

/// @file
/// Model II for several particles at a time; see ModelII.

#include "solver/line/vector/midpoints.hpp"
#include "solver/line/vector/sweeps.hpp"
#include "solver/line/vector/walk.hpp"

namespace acstudy {
inline namespace ACSTUDY_ISA {

/// Sums over the neighbors of a particle, with m = 2 delta |W| and R = m (mu reach/|d| - sign(k) c_hat), the rate with
/// which u of the neighbor comes in, but for 1/(2 delta N).
struct SymmetricSums {
  Lanes moment = {};  ///< of |d| m
  Lanes R = {}, R_u_local = {}, R_u_nonlocal = {};
  Lanes c_hat = {}, c = {};  ///< of sign(k) c_hat m and sign(k) c m
};

template <bool local, bool nonlocal, class Midpoints, class K>
class Symmetric {
 public:
  Symmetric(const SweepRange& range, const SymmetricSweep& sweep, K kernel)
      : range_(range), sweep_(sweep), kernel_(kernel) {}

  /// @return number of pairs
  std::int64_t run() const {
    std::int64_t pairs = 0;
    for (std::ptrdiff_t j = range_.begin; j < range_.end; j += lane_count) {
      const unsigned counted = first_lanes(range_.end - j);
      const Viewpoint from{load(range_.x + j), spread(range_.inside), range_.delta, 1.0 / range_.delta};
      Side<+1, K> left(range_.x + j, from, counted, kernel_);
      Side<-1, K> right(range_.x + j, from, counted, kernel_);
      // A neighbor that ties with the horizon stands at it: only the nearest may be beyond.
      const Lanes reach = max(spread(range_.delta), max(left.neighbor().distance, right.neighbor().distance));
      const Lanes viscosity = sweep_.mu * reach;
      const Midpoints midpoints(sweep_, j);
      SymmetricSums sum;
      const auto mass = [&]<KernelPiece piece>(Lanes z)
                            ACSTUDY_ALWAYS_INLINE { return kernel_.template mass<piece>(z); };
      const auto add = [&]<KernelPiece piece, int s>(Side<s, K>& side) ACSTUDY_ALWAYS_INLINE {
        pairs += side.count();
        const Neighbor neighbor = side.neighbor();
        const Lanes m = side.template step<piece>(mass), decay = viscosity / neighbor.distance;
        const std::ptrdiff_t i = j - s * neighbor.k;
        const auto [c_hat, c] = midpoints.at(i, neighbor.x);
        // W < 0 on the left
        const auto add_signed = [](Lanes& to, Lanes value)
                                    ACSTUDY_ALWAYS_INLINE { s > 0 ? void(to -= value) : void(to += value); };
        const Lanes R = m * (s > 0 ? decay + c_hat : decay - c_hat);
        sum.moment += neighbor.distance * m;
        sum.R += R;
        if constexpr (local) {
          add_signed(sum.c_hat, c_hat * m);
          sum.R_u_local += R * load(sweep_.local.u + i);
        }
        if constexpr (nonlocal) {
          add_signed(sum.c, c * m);
          sum.R_u_nonlocal += R * load(sweep_.nonlocal.u + i);
        }
      };
      walk<K>(add, left, right);
      finish(j, sum);
    }
    return pairs;
  }

 private:
  /// (3.8) and (3.10) with the sums taken apart. The rate of a particle's own u is minus the sum of
  /// m (mu reach/|d| + sign(k) c_hat), to which (3.10) adds 2 sign(k) b m.
  void finish(std::ptrdiff_t j, const SymmetricSums& sum) const {
    const Lanes per_moment = 1.0 / sum.moment;
    if constexpr (local) {
      const Lanes u = load(sweep_.local.u + j), own = sum.R + 2.0 * sum.c_hat;
      store(sweep_.local.rate + j, (sum.R_u_local - own * u) * per_moment - load(sweep_.b_prime + j) * u);
    }
    if constexpr (nonlocal) {
      const Lanes u = load(sweep_.nonlocal.u + j), own = sum.R + 2.0 * sum.c;
      store(sweep_.nonlocal.rate + j, (sum.R_u_nonlocal - own * u) * per_moment);
    }
  }

  const SweepRange& range_;
  const SymmetricSweep& sweep_;
  K kernel_;
};

template <class Midpoints, class K>
std::int64_t symmetric_with(const SweepRange& range, const SymmetricSweep& sweep, K kernel) {
  const bool local = sweep.local.u != nullptr, nonlocal = sweep.nonlocal.u != nullptr;
  if (local && nonlocal) return Symmetric<true, true, Midpoints, K>(range, sweep, kernel).run();
  if (local) return Symmetric<true, false, Midpoints, K>(range, sweep, kernel).run();
  return Symmetric<false, true, Midpoints, K>(range, sweep, kernel).run();
}

template <class K>
std::int64_t symmetric_sweep_of(const SweepRange& range, const SymmetricSweep& sweep, K kernel) {
  if (sweep.panels.terms > 0) return symmetric_with<PolynomialMidpoints>(range, sweep, kernel);
  // Numbers of modes that are not here take the next larger ones; the rest of their coefficients is zero.
  const int modes = sweep.c.modes > sweep.b.modes ? sweep.c.modes : sweep.b.modes;
  if (modes <= 1) return symmetric_with<ModalMidpoints<1, 1>>(range, sweep, kernel);
  if (modes == 2) return symmetric_with<ModalMidpoints<2, 2>>(range, sweep, kernel);
  return symmetric_with<ModalMidpoints<most_modes, most_modes>>(range, sweep, kernel);
}

inline std::int64_t symmetric_sweep(const SweepRange& range, const SymmetricSweep& sweep) {
  const SweepKernel& kernel = sweep.kernel;
  if (kernel.form == SweepKernel::Form::cubic_spline) return symmetric_sweep_of(range, sweep, CubicSplineLanes{});
  return symmetric_sweep_of(range, sweep, TableLanes(kernel));
}

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
