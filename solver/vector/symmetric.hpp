#pragma once

/// @file
/// Model II for several particles at a time; see ModelII.

#include "solver/vector/sweeps.hpp"
#include "solver/vector/walk.hpp"

namespace acstudy {
inline namespace ACSTUDY_ISA {

/// c_hat and b at the midpoints between particles and their neighbors.
template <int modes>
class Midpoints {
 public:
  Midpoints(const SymmetricSweep& sweep, std::ptrdiff_t j) : sweep_(sweep) {
    for (int n = 0; n < modes; ++n) {
      const Lanes C = load(sweep.half_cosine[n] + j), S = load(sweep.half_sine[n] + j);
      c_hat_C_[n] = sweep.c_hat.cosine[n] * C + sweep.c_hat.sine[n] * S;
      c_hat_S_[n] = sweep.c_hat.sine[n] * C - sweep.c_hat.cosine[n] * S;
      b_C_[n] = sweep.b.cosine[n] * C + sweep.b.sine[n] * S;
      b_S_[n] = sweep.b.sine[n] * C - sweep.b.cosine[n] * S;
    }
  }
  Lanes c_hat(std::ptrdiff_t i) const { return at(i, sweep_.c_hat.constant, c_hat_C_, c_hat_S_); }
  Lanes b(std::ptrdiff_t i) const { return at(i, sweep_.b.constant, b_C_, b_S_); }

 private:
  Lanes at(std::ptrdiff_t i, double constant, const Lanes (&by_C)[modes + 1], const Lanes (&by_S)[modes + 1]) const {
    Lanes value = spread(constant);
    for (int n = 0; n < modes; ++n) {
      value += by_C[n] * load(sweep_.half_cosine[n] + i);
      value += by_S[n] * load(sweep_.half_sine[n] + i);
    }
    return value;
  }

  const SymmetricSweep& sweep_;
  Lanes c_hat_C_[modes + 1], c_hat_S_[modes + 1], b_C_[modes + 1], b_S_[modes + 1];
};

/// Sums over the neighbors of a particle with m = 2 delta |W|, sign(k) m = 2 delta W: of |d| m, m/|d| and sign(k) b m;
/// of sign(k) c_hat m, and the last two kinds with u of the neighbor.
struct SymmetricSums {
  Lanes moment = {}, slope = {}, b = {}, c_hat = {};
  Lanes c_hat_u_local = {}, slope_u_local = {};
  Lanes c_hat_u_nonlocal = {}, slope_u_nonlocal = {};
};

template <bool local, bool nonlocal, int modes, class K>
class Symmetric {
 public:
  Symmetric(const SweepRange& range, const SymmetricSweep& sweep, K kernel)
      : range_(range), sweep_(sweep), kernel_(kernel) {}

  std::int64_t run() {
    for (std::ptrdiff_t j = range_.begin; j < range_.end; j += lane_count) {
      const Mask counted = counting_from(0.0) < spread(static_cast<double>(range_.end - j));
      const Midpoints<modes> midpoints(sweep_, j);
      SymmetricSums sum;
      const Lanes l = add<+1>(j, midpoints, counted, sum), r = add<-1>(j, midpoints, counted, sum);
      finish(j, max(max(l, r), spread(range_.delta)), sum);
    }
    return pairs_;
  }

 private:
  /// Adds what is on the left (s = +1) or right (s = -1). @return distance of the outermost neighbor there
  template <int s>
  Lanes add(std::ptrdiff_t j, const Midpoints<modes>& midpoints, Mask counted, SymmetricSums& total) {
    SymmetricSums sum = total;
    const Lanes zero = {};
    const int counted_lanes = count(counted);
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
      // k < 0 on the left
      const Lanes signed_m = s > 0 ? -m : m;
      const Lanes c_hat_m = midpoints.c_hat(i) * signed_m;
      sum.c_hat += c_hat_m;
      if constexpr (local) {
        const Lanes u = load(sweep_.local.u + i);
        sum.c_hat_u_local += c_hat_m * u;
        sum.slope_u_local += slope * u;
      }
      if constexpr (nonlocal) {
        const Lanes u = load(sweep_.nonlocal.u + i);
        sum.b += midpoints.b(i) * signed_m;
        sum.c_hat_u_nonlocal += c_hat_m * u;
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

template <int modes, class K>
std::int64_t symmetric_with(const SweepRange& range, const SymmetricSweep& sweep, K kernel) {
  if (modes < sweep.modes) {
    if constexpr (modes < most_modes) return symmetric_with<modes + 1>(range, sweep, kernel);
  }
  const bool local = sweep.local.u != nullptr, nonlocal = sweep.nonlocal.u != nullptr;
  if (local && nonlocal) return Symmetric<true, true, modes, K>(range, sweep, kernel).run();
  if (local) return Symmetric<true, false, modes, K>(range, sweep, kernel).run();
  return Symmetric<false, true, modes, K>(range, sweep, kernel).run();
}

inline std::int64_t symmetric_sweep(const SweepRange& range, const SymmetricSweep& sweep) {
  const SweepKernel& kernel = sweep.kernel;
  if (kernel.form == SweepKernel::Form::cubic_spline) return symmetric_with<0>(range, sweep, CubicSplineLanes{});
  return symmetric_with<0>(range, sweep, ScalarLanes(kernel.kernel, kernel.first_moment, kernel.mass));
}

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
