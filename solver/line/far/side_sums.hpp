#pragma once

/// @file
/// Sums over the neighbors on one side at a cost per particle that does not grow with their number.

#include <cstddef>
#include <cstdint>

#include "solver/line/far/boxes.hpp"
#include "solver/line/far/far_sweeps.hpp"
#include "solver/line/far/order.hpp"
#include "solver/line/far/pair_sums.hpp"
#include "solver/line/vector/lanes.hpp"
#include "solver/line/vector/sweeps.hpp"

namespace acstudy::far {
inline namespace ACSTUDY_ISA {

/// The particles of a range in boxes of 1/K of a horizon. What the particles of a box see beyond their own is two
/// windows of boxes: `inner`, before the breakpoint of the kernel, and `outer`, behind it. Both move by a box from box
/// to box. Pair by pair are summed the cells in and beside the box itself, across the breakpoint and at the horizon:
/// some two boxes full, whatever δ/h is.
template <int s, class C>
class SideSums {
 public:
  /// @param rows  of the particles and as far as their windows reach, by index
  SideSums(const SweepRange& range, const double* rows, Memory& memory)
      : range_(range), order_{range.x}, rows_(rows), memory_(memory) {}

  /// Calls finish(vector, sums) for all of the particles start .. stop - 1. @return number of pairs
  template <class Finish>
  std::int64_t run(std::ptrdiff_t start, std::ptrdiff_t stop, Finish&& finish) {
    double* const lowest_index = memory_.outermost.reserve(stop - start + 2 * lane_count) + lane_count;
    outermost_ = s > 0 ? lowest_index - start : lowest_index + stop - 1;
    const std::int64_t pairs = find_outermost<s>(order_, range_.inside, start, stop, outermost_);
    const double neighbors = static_cast<double>(pairs) / static_cast<double>(stop - start);
    const Tables* const tables = stop - start < 32 ? nullptr : box_tables<C::two_pieces>(neighbors, C::per_box);
    if (tables == nullptr) {
      PairSums<s, C> pair_sums(range_, rows_, outermost_, start);
      for (std::ptrdiff_t p = start; p < stop; p += lane_count) {
        const Vector<s> vector = vector_of<s>(p, stop);
        ChannelSums<C> sums;
        pair_sums.add(vector, {0, 0, p, p, p, nullptr}, sums);
        finish(vector, sums);
      }
    } else {
      by_boxes(*tables, start, stop, finish);
    }
    return pairs;
  }

 private:
  using Polynomials = BoxPolynomials<C>;
  using Tables = BoxTables<C::two_pieces>;
  using Inner = BoxWindow<KernelPiece::inside, Tables::inner_terms, s, C>;
  /// Coefficients of a polynomial of m/z.
  static constexpr int terms = Tables::inner_terms, stride = padded(terms);

  std::ptrdiff_t outermost(std::ptrdiff_t p) const { return static_cast<std::ptrdiff_t>(outermost_[s * p]); }

  /// The window behind the breakpoint, where the kernel has one.
  auto outer_window(const Tables& tables, const Boxes<s>& boxes, double* charge) {
    if constexpr (C::two_pieces) {
      using Outer = BoxWindow<KernelPiece::outside, Tables::outer_terms, s, C>;
      const std::ptrdiff_t size = tables.boxes + 4;
      return Outer(boxes, boxes.lowest(), tables.outer, size, 1.0 / range_.delta, rows_, charge,
                   memory_.outer.reserve(Outer::memory(tables.outer, size)));
    } else {
      return NoWindow{};
    }
  }

  template <class Finish>
  void by_boxes(const Tables& tables, std::ptrdiff_t start, std::ptrdiff_t stop, Finish&& finish) {
    const std::ptrdiff_t K = tables.boxes, size = K + 4, lowest_source = outermost(start);
    const Boxes<s> boxes(order_, range_.delta / static_cast<double>(K), K, lowest_source, start, stop, memory_.boxes);
    double* const charge = memory_.charges.reserve(stop - lowest_source) - lowest_source;
    const double per_delta = 1.0 / range_.delta;
    Inner inner(boxes, C::two_pieces ? 1 - K / 2 : boxes.lowest(), tables.inner, size, per_delta, rows_, charge,
                memory_.inner.reserve(Inner::memory(tables.inner, size)));
    auto outer = outer_window(tables, boxes, charge);
    PairSums<s, C> pair_sums(range_, rows_, outermost_, start);
    Polynomials sum;
    sum.clear();
    // The reciprocals of a box enter one step later than its polynomials: their expansions hold only for particles with
    // at least one box in between.
    double beside[Inner::powers_size];
    bool has_beside = false;

    for (std::ptrdiff_t B = 0; B <= boxes.highest(); ++B) {
      sum.move(2.0);
      const std::ptrdiff_t first = boxes.first(B), end = boxes.first(B + 1);
      const std::ptrdiff_t highest = outermost(first < end ? end - 1 : first < stop ? first : stop - 1);
      while (inner.end() < B) {
        if (has_beside) inner.enter_reciprocals(beside);
        has_beside = true;
        inner.enter(boxes.first(inner.end()), boxes.first(inner.end() + 1), B, sum, beside);
      }
      // Only of the window that reaches to the horizon may a particle's outermost neighbor be part, and only of boxes
      // that are summed in full.
      const bool may_hold_outermost = !C::two_pieces && highest < boxes.first(B - 1);
      while (!inner.empty() && (inner.begin() < B + 1 - (C::two_pieces ? K / 2 : K) ||
                                (!may_hold_outermost && boxes.first(inner.begin()) <= highest))) {
        inner.leave(B, sum);
      }
      inner.drop_reciprocals();
      int entered = 0;
      if constexpr (C::two_pieces) {
        const auto drop_outer = [&]() ACSTUDY_ALWAYS_INLINE {
          while (!outer.empty() && (outer.begin() < B + 1 - K || highest >= boxes.first_cell(outer.end()))) {
            outer.leave(B, sum);
          }
          outer.drop_reciprocals();
        };
        // Here a box holds the cells that end in it, so that none of its cells lies across the breakpoint. After a gap
        // between particles many boxes enter in one step; as there is not room for all, the oldest leave in between.
        double powers[decltype(outer)::powers_size];
        while (boxes.first_cell(outer.end() + 1) < boxes.first(B - K / 2)) {
          outer.enter(boxes.first_cell(outer.end()), boxes.first_cell(outer.end() + 1), B, sum, powers);
          outer.enter_reciprocals(powers);
          drop_outer();
          ++entered;
        }
        drop_outer();
      }
      // Each move of a sum to the next box, and each box that is subtracted, costs some digits: every K/2 boxes, and
      // after a gap, the sums are formed anew.
      if (B % (K / 2) == 0 || entered > 1) {
        sum.clear();
        inner.add_to(B, sum);
        outer.add_to(B, sum);
      }
      if (first == end) continue;

      const std::ptrdiff_t near_box = inner.begin() > B - 1 ? inner.begin() : B - 1;
      const Summed summed{boxes.first_cell(outer.begin()),
                          boxes.first_cell(outer.end()),
                          boxes.first(inner.begin()),
                          boxes.first(near_box),
                          first,
                          charge};
      double local[C::over * stride] = {};
      inner.add_reciprocals(1, local, stride);
      outer.add_reciprocals(B - outer.end(), local, stride);
      add_polynomials(sum, static_cast<double>(K), local);
      for (std::ptrdiff_t p = first; p < end; p += lane_count) {
        const Vector<s> vector = vector_of<s>(p, end);
        const Lanes t = min((vector.x(order_) - boxes.center(B)) * boxes.per_radius(), spread(1.0));
        ChannelSums<C> sums = at(t, local, sum);
        pair_sums.add(vector, summed, sums);
        finish(vector, sums);
      }
    }
  }

  /// From sums over reciprocals per box width to those per horizon, and those of polynomials.
  ACSTUDY_ALWAYS_INLINE static inline void add_polynomials(const Polynomials& sum, double boxes, double* local) {
    for (int i = 0; i < C::over * stride; ++i) local[i] *= boxes;
    for (int c = 0; c < C::over; ++c) {
      for (int n = 0; n < Polynomials::over_terms; ++n) {
        local[c * stride + n] += sum.over.coefficient[n * Polynomials::over_width + c];
      }
    }
  }

  /// What the windows give to the particles at the places t of a box, in radii from its center.
  ACSTUDY_ALWAYS_INLINE static inline ChannelSums<C> at(Lanes t, const double* local, const Polynomials& sum) {
    ChannelSums<C> sums;
#pragma GCC unroll 4
    for (int c = 0; c < C::over; ++c) {
      sums.over[c] = polynomial<terms>(local + c * stride, 1, t);
    }
    if constexpr (C::plain > 0) {
      for (int f = 0; f < C::plain; ++f) {
        sums.plain[f] = polynomial<Polynomials::plain_terms>(sum.plain.coefficient + f, C::stride, t);
      }
    }
    return sums;
  }

  template <int count>
  ACSTUDY_ALWAYS_INLINE static inline Lanes polynomial(const double* coefficient, int step, Lanes t) {
    Lanes value = spread(coefficient[(count - 1) * step]);
#pragma GCC unroll 32
    for (int n = count - 2; n >= 0; --n) value = value * t + coefficient[n * step];
    return value;
  }

  const SweepRange& range_;
  Order<s> order_;
  const double* rows_;
  Memory& memory_;
  double* outermost_ = nullptr;  ///< by index
};

}  // namespace ACSTUDY_ISA
}  // namespace acstudy::far
