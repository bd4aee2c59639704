#pragma once

/// @file
/// Model I with the inverse kernel at a cost per particle that does not grow with the number of neighbors.

#include <cstddef>
#include <cstdint>

#include "solver/far/block.hpp"
#include "solver/far/exponential_sum.hpp"
#include "solver/far/far_sweeps.hpp"
#include "solver/far/moving_moments.hpp"
#include "solver/far/scratch.hpp"
#include "solver/vector/lanes.hpp"
#include "solver/vector/sweeps.hpp"

namespace acstudy::far {
inline namespace ACSTUDY_ISA {

/// For W_k as in ModelI, that is W_k = gap_k / (delta d_k) with the last cell up to the horizon, what is summed over
/// the neighbors i = j - s k of a particle: W_k itself first, then W_k field[c][i].
template <int fields>
struct WeightedFields {
  double delta;
  const double* x;                  ///< readable one beyond the windows
  const double* field[fields + 1];  ///< readable at the windows; the last entry is not used
};

/// Direct sums over those neighbors of a block that the moments do not hold.
template <int s, int fields>
class UpwindPairs {
 public:
  ACSTUDY_ALWAYS_INLINE inline UpwindPairs(const WeightedFields<fields>& weighted, const Block<s>& block)
      : weighted_(weighted), order_{weighted.x}, block_(block) {}

  /// Adds neighbors first .. last - 1, all of them inside of every lane's outermost.
  ACSTUDY_ALWAYS_INLINE inline void add_inner(std::ptrdiff_t first, std::ptrdiff_t last, Lanes* sum) const {
    const std::ptrdiff_t before = last < block_.first ? last : block_.first;
    std::ptrdiff_t i = first;
    for (; i < before; ++i) add(i, order_.gap(i) / (block_.x - order_.x(i)), sum);
    for (; i < last; ++i) {
      const Lanes W = order_.gap(i) / (block_.x - order_.x(i));
      add(i, block_.p > spread(static_cast<double>(i)) ? W : Lanes{}, sum);
    }
  }

  /// Adds neighbors first .. last - 1. Some may be the outermost of a lane, whose cell reaches to the horizon, or not
  /// be its neighbors at all.
  ACSTUDY_ALWAYS_INLINE inline void add_outer(std::ptrdiff_t first, std::ptrdiff_t last, Lanes* sum) const {
    for (std::ptrdiff_t i = first; i < last; ++i) {
      const Lanes p_i = spread(static_cast<double>(i));
      const Lanes rest = max(weighted_.delta - (block_.x - order_.x(i + 1)), Lanes{});
      const Lanes width = block_.outer == p_i ? rest : min(spread(order_.gap(i)), rest);
      const Lanes W = width / (block_.x - order_.x(i));
      const Mask seen = (block_.outer <= p_i) & (block_.p > p_i);
      add(i, seen ? W : Lanes{}, sum);
    }
  }

 private:
  ACSTUDY_ALWAYS_INLINE inline void add(std::ptrdiff_t i, Lanes W, Lanes* sum) const {
    sum[0] += W;
    for (int c = 0; c < fields; ++c) sum[1 + c] += W * weighted_.field[c][s * i];
  }

  const WeightedFields<fields>& weighted_;
  Order<s> order_;
  const Block<s>& block_;
};

/// Hands a panel of neighbors over to the moments.
template <int s, int fields>
ACSTUDY_ALWAYS_INLINE inline void take_in(const WeightedFields<fields>& weighted, std::ptrdiff_t first,
                                          MovingMoments<fields + 1>& moments) {
  const Order<s> order{weighted.x};
  double x[panel_size], charge[(fields + 1) * panel_size];
  for (int i = 0; i < panel_size; ++i) {
    x[i] = order.x(first + i);
    charge[i] = order.gap(first + i);
    for (int c = 0; c < fields; ++c) {
      charge[(1 + c) * panel_size + i] = charge[i] * weighted.field[c][s * (first + i)];
    }
  }
  moments.push(x, charge);
}

/// Calls finish(block, sum) for blocks of the particles begin .. end - 1, which all look to the same side, with their
/// weighted fields times delta. @return the number of neighbors
///
/// Pairs up to a distance delta/ratio apart are summed directly, and so are those of some ten neighbors around the
/// horizon, where cells are cut. Those between are left to the moments. Their error is that of the exponential sum,
/// 3e-15 of each weight, besides the round-off of the pairs' distances, which direct sums have as well.
template <int s, int fields, class Finish>
std::int64_t each_block(const WeightedFields<fields>& weighted, double inside, std::ptrdiff_t begin, std::ptrdiff_t end,
                        Memory& memory, Finish finish) {
  const Order<s> order{weighted.x};
  const std::ptrdiff_t start = s > 0 ? begin : 1 - end, stop = start + (end - begin);
  double* const outermost = memory.outermost.reserve(end - begin);
  const std::ptrdiff_t widest = find_outermost<s>(order, inside, start, stop, outermost);
  std::int64_t pairs = 0;
  for (std::ptrdiff_t p = start; p < stop; ++p) pairs += p - static_cast<std::ptrdiff_t>(outermost[p - start]);

  const int log2_ratio = log2_ratio_for(pairs / (end - begin));
  // To fill a window takes as long as to sum some ten particles directly.
  const bool directly = log2_ratio == 0 || end - begin < 32;
  const ExponentialSum& reciprocal = reciprocal_sum(directly ? 1 : log2_ratio);
  const double nearest = weighted.delta / reciprocal.ratio;
  const std::ptrdiff_t panels = widest / panel_size + 2;
  using Moments = MovingMoments<fields + 1>;
  Moments moments(reciprocal, nearest, panels, memory.moments.reserve(Moments::memory(panels, reciprocal)));
  const auto panel_from = [=](std::ptrdiff_t p) { return start + ((p - start + panel_size - 1) & -panel_size); };

  // The moments hold the panels from `back` to `front`.
  std::ptrdiff_t back = start, front = start;
  for (std::ptrdiff_t p = start; p < stop; p += lane_count) {
    const Block<s> block(order, outermost + (p - start), p, stop);
    const std::ptrdiff_t inner = directly ? stop : panel_from(block.highest + 2);
    if (moments.empty()) back = front = inner;
    while (front + panel_size <= p && order.x(p) - order.x(front + panel_size - 1) >= nearest) {
      take_in<s>(weighted, front, moments);
      front += panel_size;
    }
    for (; back < inner && !moments.empty(); back += panel_size) moments.pop();
    if (back < inner) back = front = inner;

    Lanes sum[fields + 1] = {};
    const UpwindPairs<s, fields> direct(weighted, block);
    const std::ptrdiff_t last = p + block.count - 1;
    direct.add_outer(block.lowest, back < last ? back : last, sum);
    if (!moments.empty()) moments.add(order.x(p), block.x, sum);
    direct.add_inner(front, last, sum);
    finish(block, sum);
  }
  return pairs;
}

template <bool local, bool nonlocal>
class FarUpwind {
 public:
  FarUpwind(const SweepRange& range, const UpwindSweep& sweep, Memory& memory)
      : range_(range), sweep_(sweep), memory_(memory), weighted_{range.delta, range.x, {}} {
    int c = 0;
    if constexpr (local) weighted_.field[c++] = sweep.local.flux;
    if constexpr (nonlocal) {
      weighted_.field[c++] = sweep.b;
      weighted_.field[c++] = sweep.nonlocal.flux;
    }
  }

  std::int64_t run() {
    std::int64_t pairs = 0;
    for (std::ptrdiff_t begin = range_.begin, end = begin; begin < range_.end; begin = end) {
      const bool left = sweep_.c_hat[begin] > 0.0;
      while (end < range_.end && (sweep_.c_hat[end] > 0.0) == left) ++end;
      pairs += left ? side<+1>(begin, end) : side<-1>(begin, end);
    }
    return pairs;
  }

 private:
  static constexpr int fields = (local ? 1 : 0) + (nonlocal ? 2 : 0);

  template <int s>
  std::int64_t side(std::ptrdiff_t begin, std::ptrdiff_t end) {
    return each_block<s>(weighted_, range_.inside, begin, end, memory_,
                         [this](const Block<s>& block, const Lanes* sum) { finish(block, sum); });
  }

  /// (2.9) and (2.11) with the sums taken apart.
  template <int s>
  ACSTUDY_ALWAYS_INLINE inline void finish(const Block<s>& block, const Lanes* sum) const {
    const double per_delta = s / range_.delta;
    if constexpr (local) {
      const Lanes u = block.read(sweep_.local.u), flux = block.read(sweep_.c_hat) * u;
      block.write(-block.read(sweep_.b_prime) * u - per_delta * (flux * sum[0] - sum[1]), sweep_.local.rate);
    }
    if constexpr (nonlocal) {
      const Lanes u = block.read(sweep_.nonlocal.u), b = sum[fields - 1], flux = sum[fields];
      block.write(-per_delta * ((block.read(sweep_.c) * sum[0] - b) * u - flux), sweep_.nonlocal.rate);
    }
  }

  const SweepRange& range_;
  const UpwindSweep& sweep_;
  Memory& memory_;
  WeightedFields<fields> weighted_;
};

inline std::int64_t upwind_sweep(const SweepRange& range, const UpwindSweep& sweep, Memory& memory) {
  const bool local = sweep.local.u != nullptr, nonlocal = sweep.nonlocal.u != nullptr;
  if (local && nonlocal) return FarUpwind<true, true>(range, sweep, memory).run();
  if (local) return FarUpwind<true, false>(range, sweep, memory).run();
  return FarUpwind<false, true>(range, sweep, memory).run();
}

}  // namespace ACSTUDY_ISA
}  // namespace acstudy::far
