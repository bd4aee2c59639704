#pragma once

/// @file
/// Model I at a cost per particle that does not grow with the number of neighbors.

#include <cstddef>
#include <cstdint>

#include "solver/line/far/far_sweeps.hpp"
#include "solver/line/far/side_sums.hpp"

namespace acstudy::far {
inline namespace ACSTUDY_ISA {

/// Rows are 1, then c_hat u of the local form, then b and c_hat u of the nonlocal form.
template <bool local, bool nonlocal, class Moment>
class FarUpwind {
 public:
  FarUpwind(const SweepRange& range, const UpwindSweep& sweep, double scale, Memory& memory)
      : range_(range), sweep_(sweep), scale_(scale / range.delta), memory_(memory) {}

  std::int64_t run() {
    const double* const rows = fill_rows();
    std::int64_t pairs = 0;
    for (std::ptrdiff_t begin = range_.begin, end = begin; begin < range_.end; begin = end) {
      const bool left = sweep_.c_hat[begin] > 0.0;
      while (end < range_.end && (sweep_.c_hat[end] > 0.0) == left) ++end;
      if (left) {
        pairs += SideSums<+1, Sums>(range_, rows, memory_).run(begin, end, [&](const auto& vector, const auto& sums) {
          finish<+1>(vector, sums);
        });
      } else {
        pairs += SideSums<-1, Sums>(range_, rows, memory_)
                     .run(1 - end, 1 - begin, [&](const auto& vector, const auto& sums) { finish<-1>(vector, sums); });
      }
    }
    return pairs;
  }

 private:
  using Sums = Channels < Moment, 1 + (local ? 1 : 0) + (nonlocal ? 2 : 0), 0, Moment::breakpoint<1.0 ? 16 : 24>;

  const double* fill_rows() const {
    const auto [first, last] = sources_of(range_.x, range_.inside, range_.begin, range_.end);
    const std::ptrdiff_t size = (last - first) * Sums::stride + Sums::margin;
    double* const memory = memory_.rows.reserve(size);
    double* const rows = memory - first * Sums::stride;
    for (std::ptrdiff_t j = first; j < last; ++j) {
      double* const row = rows + j * Sums::stride;
      int c = 0;
      row[c++] = 1.0;
      if constexpr (local) row[c++] = sweep_.local.flux[j];
      if constexpr (nonlocal) {
        row[c++] = sweep_.b[j];
        row[c++] = sweep_.nonlocal.flux[j];
      }
      for (; c < Sums::stride; ++c) row[c] = 0.0;
    }
    for (int k = 0; k < Sums::margin; ++k) memory[size - Sums::margin + k] = 0.0;
    return rows;
  }

  /// (2.9) and (2.11) with the sums taken apart.
  template <int s>
  ACSTUDY_ALWAYS_INLINE inline void finish(const Vector<s>& vector, const ChannelSums<Sums>& sums) const {
    const double scale = s * scale_;
    const Lanes* const sum = sums.over;
    if constexpr (local) {
      const Lanes u = vector.read(sweep_.local.u), flux = vector.read(sweep_.c_hat) * u;
      vector.write(-vector.read(sweep_.b_prime) * u - scale * (flux * sum[0] - sum[1]), sweep_.local.rate);
    }
    if constexpr (nonlocal) {
      const Lanes u = vector.read(sweep_.nonlocal.u), b = sum[Sums::over - 2], flux = sum[Sums::over - 1];
      vector.write(-scale * ((vector.read(sweep_.c) * sum[0] - b) * u - flux), sweep_.nonlocal.rate);
    }
  }

  const SweepRange& range_;
  const UpwindSweep& sweep_;
  double scale_;
  Memory& memory_;
};

template <class Moment>
std::int64_t upwind_with(const SweepRange& range, const UpwindSweep& sweep, double scale, Memory& memory) {
  const bool local = sweep.local.u != nullptr, nonlocal = sweep.nonlocal.u != nullptr;
  if (local && nonlocal) return FarUpwind<true, true, Moment>(range, sweep, scale, memory).run();
  if (local) return FarUpwind<true, false, Moment>(range, sweep, scale, memory).run();
  return FarUpwind<false, true, Moment>(range, sweep, scale, memory).run();
}

inline std::int64_t upwind_sweep(const SweepRange& range, const UpwindSweep& sweep, Memory& memory) {
  if (sweep.kernel.form == SweepKernel::Form::inverse) {
    return upwind_with<InverseFirstMoment>(range, sweep, InverseLanes::moment_scale, memory);
  }
  return upwind_with<SplineFirstMoment>(range, sweep, CubicSplineLanes::moment_scale, memory);
}

}  // namespace ACSTUDY_ISA
}  // namespace acstudy::far
