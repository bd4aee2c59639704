#pragma once

/// @file
/// Sums over the neighbors on one side at a cost per particle that does not grow with their number.

#include <cstddef>
#include <cstdint>

#include "solver/far/box_tables.hpp"
#include "solver/far/order.hpp"
#include "solver/far/pair_sums.hpp"
#include "solver/far/polynomial_sums.hpp"
#include "solver/far/reciprocal_window.hpp"
#include "solver/vector/lanes.hpp"
#include "solver/vector/sweeps.hpp"

namespace acstudy::far {
inline namespace ACSTUDY_ISA {

template <int s, class C>
class SideSums {
 public:
  using Moment = typename C::Moment;

  /// @param rows  of the particles and as far as their windows reach, by index
  SideSums(const SweepRange& range, const double* rows, Memory& memory)
      : range_(range), order_{range.x}, rows_(rows), per_delta_(1.0 / range.delta), memory_(memory) {}

  /// Calls finish(vector, sums) for all of the particles start .. stop - 1. @return number of pairs
  template <class Finish>
  std::int64_t run(std::ptrdiff_t start, std::ptrdiff_t stop, Finish&& finish) {
    double* const lowest_index = memory_.outermost.reserve(stop - start + 2 * lane_count) + lane_count;
    outermost_ = s > 0 ? lowest_index - start : lowest_index + stop - 1;
    const std::int64_t pairs = find_outermost<s>(order_, range_.inside, start, stop, outermost_);
    const double neighbors = static_cast<double>(pairs) / static_cast<double>(stop - start);
    const BoxTables* const tables = stop - start < 32 ? nullptr : box_tables(neighbors, C::per_box);
    if (tables == nullptr) {
      PairSums<s, C> direct(range_, rows_, outermost_, start);
      for (std::ptrdiff_t p = start; p < stop; p += lane_count) {
        const Vector<s> vector = vector_of(p, stop);
        ChannelSums<C> sums;
        direct.add(vector, {0, 0, p, p, p, nullptr}, sums);
        finish(vector, sums);
      }
    } else {
      by_boxes(*tables, start, stop, finish);
    }
    return pairs;
  }

 private:
  static constexpr int over_terms = Moment::degree - 1, plain_terms = C::plain > 0 ? Moment::degree : 0;
  static constexpr int over_width = (C::over + lane_count - 1) / lane_count * lane_count;
  static constexpr int powers_size = C::over * padded_terms;

  struct Polynomials {
    PolynomialSums<over_terms, over_width> over;
    PolynomialSums<plain_terms, C::stride> plain;

    ACSTUDY_ALWAYS_INLINE inline void clear() {
      over.clear();
      plain.clear();
    }
    ACSTUDY_ALWAYS_INLINE inline void move(double h) {
      over.move(h);
      plain.move(h);
    }
    ACSTUDY_ALWAYS_INLINE inline void add(const Polynomials& other, double h, double sign) {
      over.add(other.over, h, sign);
      plain.add(other.plain, h, sign);
    }
  };
  static constexpr std::ptrdiff_t polynomials_size = (sizeof(Polynomials) + 63) / 64 * 8;

  std::ptrdiff_t outermost(std::ptrdiff_t p) const { return static_cast<std::ptrdiff_t>(outermost_[s * p]); }
  static Vector<s> vector_of(std::ptrdiff_t p, std::ptrdiff_t stop) {
    return {p, stop - p < lane_count ? static_cast<int>(stop - p) : lane_count};
  }
  const double* row(std::ptrdiff_t p) const { return rows_ + s * p * C::stride; }

  /// powers[v][l] = t^(v lane_count + l)
  ACSTUDY_ALWAYS_INLINE static inline void monomials(double t, Lanes* powers) {
    Mask exponent;
    for (int l = 0; l < lane_count; ++l) exponent[l] = l;
    powers[0] = spread(1.0);
    double power = t;
#pragma GCC unroll 4
    for (int bit = 1; bit < lane_count; bit *= 2) {
      powers[0] = powers[0] * ((exponent & bit) != 0 ? spread(power) : spread(1.0));
      power *= power;
    }
#pragma GCC unroll 16
    for (int v = 1; v < padded_terms / lane_count; ++v) powers[v] = powers[v - 1] * power;
  }

  /// What the sources first .. last - 1, in a box about `center`, add to the windows: m is a polynomial, m/z a
  /// polynomial and charge/z.
  template <Piece piece>
  ACSTUDY_ALWAYS_INLINE inline void take_in(std::ptrdiff_t first, std::ptrdiff_t last, double center, double per_radius,
                                            double* charge, double* charge_powers, Polynomials& polynomials) const {
    constexpr int vectors = padded_terms / lane_count, over_vectors = over_width / lane_count,
                  plain_vectors = C::stride / lane_count;
    const double kappa = per_delta_ / per_radius;
    Lanes powers_sum[C::over * vectors] = {};
    Lanes over_sum[over_terms * over_vectors + 1] = {}, plain_sum[plain_terms * plain_vectors + 1] = {};
    for (std::ptrdiff_t p = first; p < last; p += lane_count) {
      const Vector<s> vector = vector_of(p, last);
      const Lanes tau = (vector.x(order_) - center) * per_radius;
      Lanes D[Moment::degree];
      moment_coefficients<Moment, piece>(vector.gap(order_) * per_delta_, D);
      double taus[lane_count], charges[lane_count], over[over_terms + 1][lane_count],
          plain[plain_terms + 1][lane_count];
      store(taus, tau);
      store(charges, D[0]);
      // z = kappa (u - tau), with u from the center on in half boxes.
      double scale = 1.0;
      for (int n = 1; n < Moment::degree; ++n) D[n] *= scale *= kappa;
      if constexpr (plain_terms > 0) {
        Lanes coefficient[plain_terms];
        for (int n = 0; n < plain_terms; ++n) coefficient[n] = D[n];
        move_origin<plain_terms>(coefficient, -tau);
        for (int n = 0; n < plain_terms; ++n) store(plain[n], coefficient[n]);
      }
      if constexpr (over_terms > 0) {
        move_origin<over_terms>(D + 1, -tau);
        for (int n = 0; n < over_terms; ++n) store(over[n], D[n + 1] * (1.0 / kappa));
      }
      for (int k = 0; k < vector.count; ++k) {
        const int lane = Vector<s>::lane(k);
        const double* const r = row(p + k);
        charge[p + k] = charges[lane];
        Lanes power[vectors];
        monomials(taus[lane], power);
#pragma GCC unroll 4
        for (int c = 0; c < C::over; ++c) {
          const double charge_c = charges[lane] * r[c];
#pragma GCC unroll 16
          for (int v = 0; v < vectors; ++v) powers_sum[c * vectors + v] += power[v] * charge_c;
        }
#pragma GCC unroll 4
        for (int n = 0; n < over_terms; ++n) {
#pragma GCC unroll 4
          for (int v = 0; v < over_vectors; ++v) {
            over_sum[n * over_vectors + v] += load(r + v * lane_count) * over[n][lane];
          }
        }
#pragma GCC unroll 4
        for (int n = 0; n < plain_terms; ++n) {
#pragma GCC unroll 16
          for (int v = 0; v < plain_vectors; ++v) {
            plain_sum[n * plain_vectors + v] += load(r + v * lane_count) * plain[n][lane];
          }
        }
      }
    }
    for (int k = 0; k < C::over * vectors; ++k) store(charge_powers + k * lane_count, powers_sum[k]);
    for (int k = 0; k < over_terms * over_vectors; ++k) {
      store(polynomials.over.coefficient + k * lane_count, over_sum[k]);
    }
    for (int k = 0; k < plain_terms * plain_vectors; ++k) {
      store(polynomials.plain.coefficient + k * lane_count, plain_sum[k]);
    }
  }

  template <class Finish>
  void by_boxes(const BoxTables& tables, std::ptrdiff_t start, std::ptrdiff_t stop, Finish&& finish) {
    const int K = tables.boxes;
    const double width = range_.delta / K, origin = order_.x(start), per_radius = 2.0 / width;
    // Boxes from -below on; first_in(b) is the first particle at or beyond the left edge of box b.
    const std::ptrdiff_t below = K + 2, above = static_cast<std::ptrdiff_t>((order_.x(stop - 1) - origin) / width) + 2;
    double* const firsts = memory_.boxes.reserve(below + above + 1) + below;
    const std::ptrdiff_t lowest = outermost(start);
    std::ptrdiff_t q = lowest;
    for (std::ptrdiff_t b = -below; b <= above; ++b) {
      const double edge = origin + width * static_cast<double>(b);
      while (q < stop && order_.x(q) < edge) ++q;
      firsts[b] = static_cast<double>(q);
    }
    const auto first_in = [=](std::ptrdiff_t b) { return static_cast<std::ptrdiff_t>(firsts[b]); };
    // Outer boxes hold the cells that end in them, whose particle may stand a little further out: so that none reaches
    // across the breakpoint from the box before it.
    const auto first_cell_in = [=, this](std::ptrdiff_t b) {
      const std::ptrdiff_t p = first_in(b);
      return p > lowest && order_.x(p - 1) >= origin + width * (static_cast<double>(b) - 0.1) ? p - 1 : p;
    };
    const auto center = [=](std::ptrdiff_t b) { return origin + width * (static_cast<double>(b) + 0.5); };

    const BoxExpansion& inner_expansion = C::two_pieces ? tables.near : tables.whole;
    const std::ptrdiff_t ring = K + 4;
    double* memory =
        memory_.moments.reserve(ReciprocalWindow<C::over>::memory(inner_expansion, ring) +
                                ReciprocalWindow<C::over>::memory(tables.far, ring) + 2 * ring * polynomials_size);
    ReciprocalWindow<C::over> inner(inner_expansion, ring, memory);
    memory += ReciprocalWindow<C::over>::memory(inner_expansion, ring);
    ReciprocalWindow<C::over> outer(tables.far, ring, memory);
    memory += ReciprocalWindow<C::over>::memory(tables.far, ring);
    const auto ring_of = [=](std::ptrdiff_t part, std::ptrdiff_t b) {
      return reinterpret_cast<Polynomials*>(memory + (part * ring + (b + below) % ring) * polynomials_size);
    };
    double* const charge = memory_.charges.reserve(stop - lowest) - lowest;
    PairSums<s, C> direct(range_, rows_, outermost_, start);
    Polynomials sum;
    sum.clear();

    // The windows hold the boxes from `begin` to `end`; of the last one of the inner window, which is next to the
    // particles', the reciprocal window holds nothing yet.
    const std::ptrdiff_t first_inner = C::two_pieces ? 1 - K / 2 : -below;
    std::ptrdiff_t inner_begin = first_inner, inner_end = first_inner;
    std::ptrdiff_t outer_begin = -below, outer_end = -below;
    double next_to[powers_size], powers[powers_size];
    for (std::ptrdiff_t B = 0; B < above; ++B) {
      sum.move(2.0);
      const std::ptrdiff_t p_begin = first_in(B), p_end = first_in(B + 1);
      const std::ptrdiff_t highest = outermost(p_begin < p_end ? p_end - 1 : p_begin < stop ? p_begin : stop - 1);
      for (; inner_end < B; ++inner_end) {
        if (inner_end > first_inner) inner.push(next_to);
        Polynomials& own = *ring_of(0, inner_end);
        take_in<Piece::inside>(first_in(inner_end), first_in(inner_end + 1), center(inner_end), per_radius, charge,
                               next_to, own);
        sum.add(own, 2.0 * static_cast<double>(B - inner_end), 1.0);
      }
      // Only of the window that reaches to the horizon may a particle's outermost neighbor be part, and only of boxes
      // that are summed in full.
      const bool may_hold_outermost = !C::two_pieces && highest < first_in(B - 1);
      for (; inner_begin < inner_end && (inner_begin < B + 1 - (C::two_pieces ? K / 2 : K) ||
                                         (!may_hold_outermost && first_in(inner_begin) <= highest));
           ++inner_begin) {
        sum.add(*ring_of(0, inner_begin), 2.0 * static_cast<double>(B - inner_begin), -1.0);
      }
      inner.drop_before(inner_begin - first_inner);
      if constexpr (C::two_pieces) {
        const auto drop_outer = [&]() ACSTUDY_ALWAYS_INLINE {
          for (; outer_begin < outer_end && (outer_begin < B + 1 - K || highest >= first_cell_in(outer_end));
               ++outer_begin) {
            sum.add(*ring_of(1, outer_begin), 2.0 * static_cast<double>(B - outer_begin), -1.0);
          }
          outer.drop_before(outer_begin + below);
        };
        // After a gap many boxes enter at once, more than there is room for, and those that are old leave again.
        for (; first_cell_in(outer_end + 1) < first_in(B - K / 2); drop_outer()) {
          Polynomials& own = *ring_of(1, outer_end);
          take_in<Piece::outside>(first_cell_in(outer_end), first_cell_in(outer_end + 1), center(outer_end), per_radius,
                                  charge, powers, own);
          outer.push(powers);
          sum.add(own, 2.0 * static_cast<double>(B - outer_end), 1.0);
          ++outer_end;
        }
        drop_outer();
      }
      // Moved sums lose digits by the distance moved; ever so often they are formed anew.
      if (B % (K / 2) == 0) {
        sum.clear();
        for (std::ptrdiff_t b = inner_begin; b < inner_end; ++b)
          sum.add(*ring_of(0, b), 2.0 * static_cast<double>(B - b), 1.0);
        for (std::ptrdiff_t b = outer_begin; b < outer_end; ++b)
          sum.add(*ring_of(1, b), 2.0 * static_cast<double>(B - b), 1.0);
      }
      if (p_begin == p_end) continue;

      double local[powers_size] = {};
      if (!inner.empty()) inner.add_to(1.0, local);
      if (!outer.empty()) outer.add_to(static_cast<double>(B - outer_end), local);
      for (int k = 0; k < powers_size; ++k) local[k] *= K;
      if constexpr (over_terms > 0) {
        for (int c = 0; c < C::over; ++c) {
          for (int n = 0; n < over_terms; ++n) local[c * padded_terms + n] += sum.over.coefficient[n * over_width + c];
        }
      }
      const std::ptrdiff_t near_box = inner_begin > B - 1 ? inner_begin : B - 1;
      const Summed summed{first_cell_in(outer_begin),
                          first_cell_in(outer_end),
                          first_in(inner_begin),
                          first_in(near_box),
                          p_begin,
                          charge};
      for (std::ptrdiff_t p = p_begin; p < p_end; p += lane_count) {
        const Vector<s> vector = vector_of(p, p_end);
        const Lanes t = min((vector.x(order_) - center(B)) * per_radius, spread(1.0));
        ChannelSums<C> sums;
#pragma GCC unroll 4
        for (int c = 0; c < C::over; ++c) {
          Lanes value = spread(local[c * padded_terms + expansion_terms - 1]);
#pragma GCC unroll 32
          for (int n = expansion_terms - 2; n >= 0; --n) value = value * t + local[c * padded_terms + n];
          sums.over[c] = value;
        }
        if constexpr (C::plain > 0) {
          for (int f = 0; f < C::plain; ++f) {
            Lanes value = spread(sum.plain.coefficient[(plain_terms - 1) * C::stride + f]);
            for (int n = plain_terms - 2; n >= 0; --n) value = value * t + sum.plain.coefficient[n * C::stride + f];
            sums.plain[f] = value;
          }
        }
        direct.add(vector, summed, sums);
        finish(vector, sums);
      }
    }
  }

  const SweepRange& range_;
  Order<s> order_;
  const double* rows_;
  double per_delta_;
  Memory& memory_;
  double* outermost_ = nullptr;  ///< by index
};

}  // namespace ACSTUDY_ISA
}  // namespace acstudy::far
