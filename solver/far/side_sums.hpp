#pragma once

/// @file
/// Sums over the neighbors on one side at a cost per particle that does not grow with their number.

#include <cstddef>
#include <cstdint>

#include "solver/far/box_tables.hpp"
#include "solver/far/cell_moments.hpp"
#include "solver/far/order.hpp"
#include "solver/far/polynomial_sums.hpp"
#include "solver/far/reciprocal_window.hpp"
#include "solver/far/scratch.hpp"
#include "solver/vector/lanes.hpp"
#include "solver/vector/sweeps.hpp"

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
};

template <int s, class C>
class SideSums {
 public:
  using Moment = typename C::Moment;

  /// @param rows  of the particles and as far as their windows reach, by index
  SideSums(const SweepRange& range, const double* rows, Memory& memory)
      : order_{range.x},
        rows_(rows),
        delta_(range.delta),
        per_delta_(1.0 / range.delta),
        inside_(range.inside),
        memory_(memory) {}

  /// Calls finish(vector, sums) for all of the particles start .. stop - 1. @return number of pairs
  template <class Finish>
  std::int64_t run(std::ptrdiff_t start, std::ptrdiff_t stop, Finish&& finish) {
    double* const lowest_index = memory_.outermost.reserve(stop - start + 2 * lane_count) + lane_count;
    outermost_ = s > 0 ? lowest_index - start : lowest_index + stop - 1;
    const std::int64_t pairs = find_outermost<s>(order_, inside_, start, stop, outermost_);
    const double neighbors = static_cast<double>(pairs) / static_cast<double>(stop - start);
    const BoxTables* const tables = stop - start < 32 ? nullptr : box_tables(neighbors, C::per_box);
    if (tables == nullptr) {
      for (std::ptrdiff_t p = start; p < stop; p += lane_count) {
        const Vector<s> vector = vector_of(p, stop);
        ChannelSums<C> sums;
        const std::ptrdiff_t outer = outermost(p);
        add_pairs(vector, {outer, outer, p, p}, sums);
        finish(vector, sums);
      }
      return pairs;
    }
    by_boxes(*tables, start, stop, finish);
    return pairs;
  }

 private:
  static constexpr bool two_pieces = Moment::breakpoint < 1.0;
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

  /// Neighbors that are not summed pair by pair: from outer_begin to outer_end and from inner_begin to inner_end.
  struct Left {
    std::ptrdiff_t outer_begin, outer_end, inner_begin, inner_end;
  };

  std::ptrdiff_t outermost(std::ptrdiff_t p) const { return static_cast<std::ptrdiff_t>(outermost_[s * p]); }
  static Vector<s> vector_of(std::ptrdiff_t p, std::ptrdiff_t stop) {
    return {p, stop - p < lane_count ? static_cast<int>(stop - p) : lane_count};
  }
  const double* row(std::ptrdiff_t p) const { return rows_ + s * p * C::stride; }

  // --- pairs ---

  ACSTUDY_ALWAYS_INLINE inline void add(Lanes m, Lanes over, std::ptrdiff_t i, ChannelSums<C>& sums) const {
    const double* const r = row(i);
#pragma GCC unroll 32
    for (int f = 0; f < C::plain; ++f) sums.plain[f] += m * r[f];
#pragma GCC unroll 4
    for (int c = 0; c < C::over; ++c) sums.over[c] += over * r[c];
  }

  /// Neighbors first .. last - 1, all inside of every particle's outermost, in cells within one piece.
  template <Piece piece>
  ACSTUDY_ALWAYS_INLINE inline void add_whole(Lanes x, std::ptrdiff_t first, std::ptrdiff_t last,
                                              ChannelSums<C>& sums) const {
    if (first >= last) return;
    double x_i = order_.x(first);
    CellLanes cell;
    cell.outer = (x - x_i) * per_delta_;
    if constexpr (two_pieces) cell.rest_outer = (delta_ - (x - x_i)) * per_delta_;
    for (std::ptrdiff_t i = first; i < last; ++i) {
      const double x_next = order_.x(i + 1);
      cell.inner = (x - x_next) * per_delta_;
      cell.width = spread((x_next - x_i) * per_delta_);
      if constexpr (two_pieces) cell.rest_inner = (delta_ - (x - x_next)) * per_delta_;
      const Lanes m = Moment::template of<piece>(cell);
      add(m, m / cell.outer, i, sums);
      x_i = x_next;
      cell.outer = cell.inner;
      cell.rest_outer = cell.rest_inner;
    }
  }

  /// Neighbors first .. last - 1. Some may be the outermost of a particle, whose cell reaches to the horizon, or not be
  /// its neighbors at all.
  ACSTUDY_ALWAYS_INLINE inline void add_some(Lanes x, Lanes p, Lanes outer, std::ptrdiff_t first, std::ptrdiff_t last,
                                             ChannelSums<C>& sums) const {
    for (std::ptrdiff_t i = first; i < last; ++i) {
      const Lanes p_i = spread(static_cast<double>(i));
      const double x_i = order_.x(i), x_next = order_.x(i + 1);
      const Mask seen = (outer <= p_i) & (p > p_i), is_outermost = outer == p_i;
      const Lanes zero = {}, one = spread(1.0), distance = x - x_i;
      CellLanes cell;
      cell.inner = (x - x_next) * per_delta_;
      cell.rest_inner = max((delta_ - (x - x_next)) * per_delta_, zero);
      cell.outer = is_outermost ? one : min(distance * per_delta_, one);
      cell.rest_outer = is_outermost ? zero : max((delta_ - distance) * per_delta_, zero);
      cell.width = is_outermost ? cell.rest_inner : min(spread((x_next - x_i) * per_delta_), cell.rest_inner);
      const Lanes z = distance * per_delta_, m = Moment::template of<Piece::any>(cell);
      add(seen ? m : zero, seen ? m / z : zero, i, sums);
      sums.reach = is_outermost ? distance : sums.reach;
    }
  }

  ACSTUDY_ALWAYS_INLINE inline void add_pairs(const Vector<s>& vector, const Left& left, ChannelSums<C>& total) const {
    const std::ptrdiff_t last = vector.first + vector.count - 1, lowest = outermost(vector.first),
                         highest = outermost(last);
    const Lanes x = vector.x(order_), p = vector.p(), outer = vector.read(outermost_);
    ChannelSums<C> sums = total;
    std::ptrdiff_t i = highest + 1 < vector.first ? highest + 1 : vector.first;
    add_some(x, p, outer, lowest, i, sums);
    const auto skip_to = [&](std::ptrdiff_t to) ACSTUDY_ALWAYS_INLINE {
      if (to > i) i = to;
    };
    if constexpr (two_pieces) {
      add_whole<Piece::outside>(x, i, left.outer_begin, sums);
      skip_to(left.outer_end);
    }
    add_whole<Piece::any>(x, i, left.inner_begin, sums);
    skip_to(left.inner_end);
    add_whole<Piece::inside>(x, i, vector.first, sums);
    skip_to(vector.first);
    add_some(x, p, outer, i, last, sums);
    total = sums;
  }

  // --- boxes ---

  /// powers[v][l] = t^(v lane_count + l)
  ACSTUDY_ALWAYS_INLINE static inline void monomials(double t, Lanes* powers) {
    const Mask exponent = __builtin_convertvector(counting_from(0.0), Mask);
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

  /// What the sources first .. last - 1 add to the windows, in a box about `center`: to the one of m/z, of which
  /// D[0]/z is left to the reciprocal window and the rest is a polynomial, and to that of m.
  template <Piece piece>
  ACSTUDY_ALWAYS_INLINE inline void take_in(std::ptrdiff_t first, std::ptrdiff_t last, double center, double per_radius,
                                            double* charge_powers, Polynomials& polynomials) const {
    constexpr int vectors = padded_terms / lane_count, over_vectors = over_width / lane_count,
                  plain_vectors = C::stride / lane_count;
    const double kappa = per_delta_ / per_radius;
    Lanes charges[C::over * vectors] = {};
    Lanes over_sum[over_terms * over_vectors + 1] = {}, plain_sum[plain_terms * plain_vectors + 1] = {};
    for (std::ptrdiff_t p = first; p < last; p += lane_count) {
      const Vector<s> vector = vector_of(p, last);
      const Lanes tau = (vector.x(order_) - center) * per_radius;
      Lanes D[Moment::degree];
      moment_coefficients<Moment, piece>(vector.gap(order_) * per_delta_, D);
      double taus[lane_count], reciprocal[lane_count], over[over_terms + 1][lane_count],
          plain[plain_terms + 1][lane_count];
      store(taus, tau);
      store(reciprocal, D[0]);
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
        Lanes power[vectors];
        monomials(taus[lane], power);
#pragma GCC unroll 4
        for (int c = 0; c < C::over; ++c) {
          const double charge = reciprocal[lane] * r[c];
#pragma GCC unroll 16
          for (int v = 0; v < vectors; ++v) charges[c * vectors + v] += power[v] * charge;
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
    for (int k = 0; k < C::over * vectors; ++k) store(charge_powers + k * lane_count, charges[k]);
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
    const double width = delta_ / K, origin = order_.x(start), per_radius = 2.0 / width;
    // Boxes from -below on; first_in(b) is the first particle at or beyond the left edge of box b.
    const std::ptrdiff_t below = K + 2, above = static_cast<std::ptrdiff_t>((order_.x(stop - 1) - origin) / width) + 2;
    double* const firsts = memory_.boxes.reserve(below + above + 1) + below;
    std::ptrdiff_t q = outermost(start);
    for (std::ptrdiff_t b = -below; b <= above; ++b) {
      const double edge = origin + width * static_cast<double>(b);
      while (q < stop && order_.x(q) < edge) ++q;
      firsts[b] = static_cast<double>(q);
    }
    const auto first_in = [=](std::ptrdiff_t b) { return static_cast<std::ptrdiff_t>(firsts[b]); };
    const auto center = [=](std::ptrdiff_t b) { return origin + width * (static_cast<double>(b) + 0.5); };

    const BoxExpansion& inner_expansion = two_pieces ? tables.near : tables.whole;
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
    Polynomials sum;
    sum.clear();

    // The windows hold the boxes from `begin` to `end`.
    std::ptrdiff_t inner_begin = two_pieces ? 1 - K / 2 : -below, inner_end = inner_begin;
    std::ptrdiff_t outer_begin = -below, outer_end = -below;
    double powers[powers_size];
    for (std::ptrdiff_t B = 0; B < above; ++B) {
      sum.move(2.0);
      const std::ptrdiff_t p_begin = first_in(B), p_end = first_in(B + 1);
      const std::ptrdiff_t highest = p_begin < p_end ? outermost(p_end - 1) : outermost_of_next(p_begin, stop);
      for (; inner_end < B - 1; ++inner_end) {
        Polynomials& own = *ring_of(0, inner_end);
        take_in<Piece::inside>(first_in(inner_end), first_in(inner_end + 1), center(inner_end), per_radius, powers,
                               own);
        inner.push(powers);
        sum.add(own, 2.0 * static_cast<double>(B - inner_end), 1.0);
      }
      for (; inner_begin < inner_end &&
             (inner_begin < B + 1 - (two_pieces ? K / 2 : K + 1) || first_in(inner_begin) <= highest);
           ++inner_begin) {
        inner.pop();
        sum.add(*ring_of(0, inner_begin), 2.0 * static_cast<double>(B - inner_begin), -1.0);
      }
      if constexpr (two_pieces) {
        for (; first_in(outer_end + 1) < first_in(B - K / 2); ++outer_end) {
          Polynomials& own = *ring_of(1, outer_end);
          take_in<Piece::outside>(first_in(outer_end), first_in(outer_end + 1), center(outer_end), per_radius, powers,
                                  own);
          outer.push(powers);
          sum.add(own, 2.0 * static_cast<double>(B - outer_end), 1.0);
        }
        for (; outer_begin < outer_end && (outer_begin < B - K || first_in(outer_begin) <= highest); ++outer_begin) {
          outer.pop();
          sum.add(*ring_of(1, outer_begin), 2.0 * static_cast<double>(B - outer_begin), -1.0);
        }
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
      if (inner_begin < inner_end) inner.add_to(1.0, local);
      if (outer_begin < outer_end) outer.add_to(static_cast<double>(B - outer_end), local);
      for (int k = 0; k < powers_size; ++k) local[k] *= K;
      if constexpr (over_terms > 0) {
        for (int c = 0; c < C::over; ++c) {
          for (int n = 0; n < over_terms; ++n) local[c * padded_terms + n] += sum.over.coefficient[n * over_width + c];
        }
      }
      const Left left{two_pieces ? first_in(outer_begin) : 0, two_pieces ? first_in(outer_end) : 0,
                      first_in(inner_begin), first_in(inner_end)};
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
        add_pairs(vector, left, sums);
        finish(vector, sums);
      }
    }
  }

  std::ptrdiff_t outermost_of_next(std::ptrdiff_t p, std::ptrdiff_t stop) const {
    return outermost(p < stop ? p : stop - 1);
  }

  Order<s> order_;
  const double* rows_;
  double delta_, per_delta_, inside_;
  Memory& memory_;
  double* outermost_ = nullptr;  ///< by index
};

}  // namespace ACSTUDY_ISA
}  // namespace acstudy::far
