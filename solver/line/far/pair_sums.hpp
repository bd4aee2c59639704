#pragma once

/// @file
/// Sums over the neighbors on one side, pair by pair, for several particles at a time.

#include <cstddef>

#include "solver/line/far/cell_moments.hpp"
#include "solver/line/far/order.hpp"
#include "solver/line/vector/lanes.hpp"
#include "solver/line/vector/sweeps.hpp"

namespace acstudy::far {
inline namespace ACSTUDY_ISA {

/// What is summed over the cells m of a side, at distances z in horizons: (m/z) row[c] for the first `over` entries of
/// the row of each neighbor, and m row[f] for the first `plain`.
///
/// @tparam per_box_  particles in a box that make the sums fastest, by measurement
template <class Moment_, int over_, int plain_, int per_box_>
struct Channels {
  using Moment = Moment_;
  static constexpr int per_box = per_box_;
  static constexpr int over = over_, plain = plain_;
  static constexpr bool two_pieces = Moment::breakpoint < 1.0;
  /// Doubles from row to row.
  static constexpr int stride = plain == 0 ? (over + 3) / 4 * 4 : (plain + 7) / 8 * 8;
  /// Doubles beyond the last row that may be read.
  static constexpr int margin = 8;
};

template <class C>
struct ChannelSums {
  Lanes over[C::over] = {};
  Lanes plain[C::plain + 1] = {};
  Lanes reach = {};  ///< distance of the outermost neighbor

  ChannelSums() = default;
  ChannelSums(const ChannelSums& other) { *this = other; }
  /// Lane by lane: a copy of the whole is made by a string instruction, which takes as long as ten neighbors.
  ACSTUDY_ALWAYS_INLINE inline ChannelSums& operator=(const ChannelSums& other) {
#pragma GCC unroll 4
    for (int c = 0; c < C::over; ++c) over[c] = other.over[c];
#pragma GCC unroll 32
    for (int f = 0; f < C::plain; ++f) plain[f] = other.plain[f];
    reach = other.reach;
    return *this;
  }
};

/// Neighbors p that have been summed otherwise, with whole cells: m from outer_begin to outer_end and from inner_begin
/// to near_end, m/z likewise but for those from near_begin on, of which charge[p]/z is missing. The first of them may
/// be the outermost of some particles, or beyond.
struct Summed {
  std::ptrdiff_t outer_begin, outer_end, inner_begin, near_begin, near_end;
  const double* charge;
};

template <int s, class C>
class PairSums {
 public:
  using Moment = typename C::Moment;

  /// @param rows       by index
  /// @param outermost  neighbor p of each particle, by index
  PairSums(const SweepRange& range, const double* rows, const double* outermost, std::ptrdiff_t start)
      : order_{range.x},
        rows_(rows),
        outermost_(outermost),
        delta_(range.delta),
        per_delta_(1.0 / range.delta),
        break_begin_(static_cast<std::ptrdiff_t>(outermost[s * start])),
        break_end_(break_begin_) {}

  /// Adds the neighbors of the vector that have not been summed otherwise. Vectors have to come in walking order.
  ACSTUDY_NEVER_INLINE void add(const Vector<s>& vector, const Summed& summed, ChannelSums<C>& total) {
    const std::ptrdiff_t last = vector.first + vector.count - 1,
                         lowest = static_cast<std::ptrdiff_t>(outermost_[s * vector.first]),
                         highest = static_cast<std::ptrdiff_t>(outermost_[s * last]);
    const Some some{vector.x(order_), vector.p(), vector.read(outermost_)};
    const Lanes x = some.x;
    find_breakpoint(vector.first, last);
    if (highest >= vector.first || break_end_ > vector.first) {
      add_some<KernelPiece::any, KernelPiece::any>(some, lowest, last, last, total);
      return;
    }
    std::ptrdiff_t i = highest + 1;
    ChannelSums<C> sums;  // of which no reference leaves this function, so that they stay in registers
    const auto up_to = [&]<KernelPiece piece>(std::ptrdiff_t to) ACSTUDY_ALWAYS_INLINE {
      add_whole<piece>(x, i, to, sums);
      if (to > i) i = to;
    };
    const auto skip_to = [&](std::ptrdiff_t to) ACSTUDY_ALWAYS_INLINE {
      if (to > i) i = to;
    };
    const bool has_outer = summed.outer_begin < summed.outer_end;
    const std::ptrdiff_t begin = has_outer                              ? summed.outer_begin
                                 : summed.inner_begin < summed.near_end ? summed.inner_begin
                                                                        : i;
    const std::ptrdiff_t first = begin < lowest ? begin : lowest, edge = begin < i ? begin : i;
    if (i <= break_begin_) {
      add_some<KernelPiece::outside, KernelPiece::outside>(some, first, edge, i, total);
    } else if (has_outer) {
      add_some<KernelPiece::any, KernelPiece::outside>(some, first, edge, i, total);
    } else {
      add_some<KernelPiece::any, KernelPiece::inside>(some, first, edge, i, total);
    }
    sums = total;
    if constexpr (C::two_pieces) {
      if (has_outer) {
        up_to.template operator()<KernelPiece::outside>(summed.outer_begin);
        skip_to(summed.outer_end);
      }
      up_to.template operator()<KernelPiece::outside>(break_begin_ < summed.inner_begin ? break_begin_
                                                                                        : summed.inner_begin);
      up_to.template operator()<KernelPiece::any>(break_end_ < summed.inner_begin ? break_end_ : summed.inner_begin);
    }
    up_to.template operator()<KernelPiece::inside>(summed.inner_begin);
    skip_to(summed.near_begin);
    if (i < summed.near_end) {
      add_charges(x, summed.charge, i, summed.near_end, sums);
      i = summed.near_end;
    }
    up_to.template operator()<KernelPiece::inside>(vector.first);
    add_each_others(some, vector.first, last, sums);
    total = sums;
  }

 private:
  /// Particles of which not all have the same neighbors.
  struct Some {
    Lanes x, p, outer;
  };

  const double* row(std::ptrdiff_t p) const { return rows_ + s * p * C::stride; }

  ACSTUDY_ALWAYS_INLINE inline void add_cell(Lanes m, Lanes over, std::ptrdiff_t i, ChannelSums<C>& sums) const {
    const double* const r = row(i);
#pragma GCC unroll 32
    for (int f = 0; f < C::plain; ++f) sums.plain[f] += m * r[f];
#pragma GCC unroll 4
    for (int c = 0; c < C::over; ++c) sums.over[c] += over * r[c];
  }

  /// Finds which cells may lie across the breakpoint for some of the particles first .. last: those of the neighbors
  /// break_begin_ .. break_end_ - 1.
  ACSTUDY_ALWAYS_INLINE inline void find_breakpoint(std::ptrdiff_t first, std::ptrdiff_t last) {
    const double until = Moment::breakpoint * delta_;
    while (order_.x(first) - order_.x(break_begin_ + 1) >= until) ++break_begin_;
    while (order_.x(last) - order_.x(break_end_) > until) ++break_end_;
  }

  /// Neighbors first .. last - 1 of all particles, none of them the outermost, in cells within one piece.
  template <KernelPiece piece>
  ACSTUDY_ALWAYS_INLINE inline void add_whole(Lanes x, std::ptrdiff_t first, std::ptrdiff_t last,
                                              ChannelSums<C>& sums) const {
    if (first >= last) return;
    Lanes z = (x - order_.x(first)) * per_delta_, within = Moment::template within<piece>(z);
    for (std::ptrdiff_t i = first; i < last; ++i) {
      const Lanes z_inner = (x - order_.x(i + 1)) * per_delta_, within_inner = Moment::template within<piece>(z_inner);
      const Lanes m = within - within_inner;
      add_cell(m, m / z, i, sums);
      z = z_inner;
      within = within_inner;
    }
  }

  /// charge/z of the neighbors first .. last - 1.
  ACSTUDY_ALWAYS_INLINE inline void add_charges(Lanes x, const double* charge, std::ptrdiff_t first,
                                                std::ptrdiff_t last, ChannelSums<C>& sums) const {
    for (std::ptrdiff_t i = first; i < last; ++i) {
      const Lanes over = (charge[i] * delta_) / (x - order_.x(i));
#pragma GCC unroll 4
      for (int c = 0; c < C::over; ++c) sums.over[c] += over * row(i)[c];
    }
  }

  /// Neighbors first .. last - 1, the particles first .. last, which see each other.
  ACSTUDY_ALWAYS_INLINE inline void add_each_others(const Some& some, std::ptrdiff_t first, std::ptrdiff_t last,
                                                    ChannelSums<C>& sums) const {
    for (std::ptrdiff_t i = first; i < last; ++i) {
      const Lanes z = (some.x - order_.x(i)) * per_delta_, z_inner = (some.x - order_.x(i + 1)) * per_delta_;
      const Lanes m =
          Moment::template within<KernelPiece::inside>(z) - Moment::template within<KernelPiece::inside>(z_inner);
      const Choice seen = at_most(spread(static_cast<double>(i + 1)), some.p);
      add_cell(select(seen, m, Lanes{}), select(seen, m / z, Lanes{}), i, sums);
    }
  }

  /// Neighbors first .. last - 1 of some of the particles. Some may be the outermost of a particle, whose cell reaches
  /// to the horizon. Those from `summed` on have been summed as whole cells, within piece `whole`.
  template <KernelPiece piece, KernelPiece whole>
  ACSTUDY_NEVER_INLINE void add_some(const Some& some, std::ptrdiff_t first, std::ptrdiff_t summed, std::ptrdiff_t last,
                                     ChannelSums<C>& total) const {
    if (first >= last) return;
    const auto& [x, p, outer] = some;
    ChannelSums<C> sums = total;
    const Lanes zero = {}, one = spread(1.0);
    for (std::ptrdiff_t i = first; i < last; ++i) {
      const Lanes p_i = spread(static_cast<double>(i)), distance = x - order_.x(i);
      const Choice is_outermost = at_most(outer, p_i) & at_most(p_i, outer);
      const Choice seen = at_most(outer, p_i) & at_most(p_i + 1.0, p);
      const Lanes z = distance * per_delta_, z_inner = (x - order_.x(i + 1)) * per_delta_;
      Lanes m = Moment::template within<piece>(select(is_outermost, one, min(z, one))) -
                Moment::template within<piece>(min(z_inner, one));
      m = select(seen, m, zero);
      Lanes over = select(seen, m / z, zero);
      if (i >= summed) {
        const Lanes m_whole = Moment::template within<whole>(z) - Moment::template within<whole>(z_inner);
        m -= m_whole;
        over -= m_whole / z;
      }
      add_cell(m, over, i, sums);
      sums.reach = select(is_outermost, distance, sums.reach);
    }
    total = sums;
  }

  Order<s> order_;
  const double* rows_;
  const double* outermost_;
  double delta_, per_delta_;
  std::ptrdiff_t break_begin_, break_end_;
};

}  // namespace ACSTUDY_ISA
}  // namespace acstudy::far
