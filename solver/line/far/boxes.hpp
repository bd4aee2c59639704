#pragma once

/// @file
/// Boxes of equal width along the order in which a side is walked, and windows of them.

#include <cstddef>

#include "solver/line/far/box_tables.hpp"
#include "solver/line/far/cell_moments.hpp"
#include "solver/line/far/far_sweeps.hpp"
#include "solver/line/far/order.hpp"
#include "solver/line/far/pair_sums.hpp"
#include "solver/line/far/polynomial_sums.hpp"
#include "solver/line/far/reciprocal_window.hpp"
#include "solver/line/vector/lanes.hpp"

namespace acstudy::far {
inline namespace ACSTUDY_ISA {

/// Boxes b = lowest() .. highest(), of which those from 0 on hold the particles start .. stop - 1, and the others
/// their neighbors. Coordinates in a box run from -1 to 1.
template <int s>
class Boxes {
 public:
  /// @param lowest_source  p of the outermost neighbor of `start`
  Boxes(Order<s> order, double width, std::ptrdiff_t to_horizon, std::ptrdiff_t lowest_source, std::ptrdiff_t start,
        std::ptrdiff_t stop, Scratch& memory)
      : order_(order),
        width_(width),
        origin_(order.x(start)),
        lowest_(-to_horizon - 2),
        highest_(static_cast<std::ptrdiff_t>((order.x(stop - 1) - origin_) / width) + 1),
        lowest_source_(lowest_source),
        first_(memory.reserve(highest_ - lowest_ + 2) - lowest_) {
    std::ptrdiff_t p = lowest_source;
    for (std::ptrdiff_t b = lowest_; b <= highest_ + 1; ++b) {
      while (p < stop && order.x(p) < edge(b)) ++p;
      first_[b] = static_cast<double>(p);
    }
  }

  Order<s> order() const { return order_; }
  std::ptrdiff_t lowest() const { return lowest_; }
  std::ptrdiff_t highest() const { return highest_; }
  double center(std::ptrdiff_t b) const { return edge(b) + 0.5 * width_; }
  double per_radius() const { return 2.0 / width_; }

  /// The first particle in box b or beyond it.
  std::ptrdiff_t first(std::ptrdiff_t b) const { return static_cast<std::ptrdiff_t>(first_[b]); }
  /// The first particle whose cell ends in box b or beyond it, if it stands no more than a little further out.
  std::ptrdiff_t first_cell(std::ptrdiff_t b) const {
    const std::ptrdiff_t p = first(b);
    return p > lowest_source_ && order_.x(p - 1) >= edge(b) - 0.1 * width_ ? p - 1 : p;
  }

 private:
  double edge(std::ptrdiff_t b) const { return origin_ + width_ * static_cast<double>(b); }

  Order<s> order_;
  double width_, origin_;
  std::ptrdiff_t lowest_, highest_, lowest_source_;
  double* first_;
};

/// Sums over the cells of boxes as polynomials in the coordinate of the box that they are seen from.
template <class C>
struct BoxPolynomials {
  static constexpr int over_terms = C::Moment::degree - 1, plain_terms = C::plain > 0 ? C::Moment::degree : 0;
  static constexpr int over_width = (C::over + lane_count - 1) / lane_count * lane_count;

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
  ACSTUDY_ALWAYS_INLINE inline void add(const BoxPolynomials& other, double h, double sign) {
    over.add(other.over, h, sign);
    plain.add(other.plain, h, sign);
  }
};

/// powers[v][l] = t^(v lane_count + l)
template <int vectors>
ACSTUDY_ALWAYS_INLINE inline void monomials(double t, Lanes* powers) {
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
  for (int v = 1; v < vectors; ++v) powers[v] = powers[v - 1] * power;
}

/// Consecutive boxes whose cells are within one piece of the kernel.
///
/// Of the moment m of a cell, m is a polynomial in the distance z, and m/z is a polynomial and charge/z. The window
/// keeps both of each box, and the charges of all.
template <KernelPiece piece, int terms, int s, class C>
class BoxWindow {
 public:
  using Polynomials = BoxPolynomials<C>;
  using Reciprocals = ReciprocalWindow<C::over, terms>;
  static constexpr int powers_size = Reciprocals::powers_size;

  /// Doubles that a window of at most `size` boxes needs.
  static std::ptrdiff_t memory(const BoxExpansion<terms>& expansion, std::ptrdiff_t size) {
    return Reciprocals::memory(expansion, size) + size * polynomials_size;
  }

  /// @param first      the box to enter first
  /// @param size       the most boxes that it may hold
  /// @param per_delta  1/delta
  /// @param charge     of each particle p, to be written if the piece is the inner one
  /// @param rows       by index
  /// @param memory     at a multiple of 64 bytes
  BoxWindow(const Boxes<s>& boxes, std::ptrdiff_t first, const BoxExpansion<terms>& expansion, std::ptrdiff_t size,
            double per_delta, const double* rows, double* charge, double* memory)
      : boxes_(boxes),
        first_(first),
        begin_(first),
        end_(first),
        size_(size),
        per_delta_(per_delta),
        rows_(rows),
        charge_(charge),
        reciprocals_(expansion, size, memory),
        polynomials_(memory + Reciprocals::memory(expansion, size)) {}

  /// It holds the boxes begin() .. end() - 1.
  std::ptrdiff_t begin() const { return begin_; }
  std::ptrdiff_t end() const { return end_; }
  bool empty() const { return begin_ == end_; }

  /// Box end() enters, with the sources first .. last - 1; of its reciprocals the powers of charges are given out.
  ///
  /// @param sum  polynomials about box B, to which its own are added
  ACSTUDY_ALWAYS_INLINE inline void enter(std::ptrdiff_t first, std::ptrdiff_t last, std::ptrdiff_t B, Polynomials& sum,
                                          double* powers) {
    take_in(first, last, boxes_.center(end_), *of_box(end_), powers);
    sum.add(*of_box(end_), coordinate(B, end_), 1.0);
    ++end_;
  }
  /// Box begin() leaves.
  ACSTUDY_ALWAYS_INLINE inline void leave(std::ptrdiff_t B, Polynomials& sum) {
    sum.add(*of_box(begin_), coordinate(B, begin_), -1.0);
    ++begin_;
  }
  ACSTUDY_ALWAYS_INLINE inline void add_to(std::ptrdiff_t B, Polynomials& sum) const {
    for (std::ptrdiff_t b = begin_; b < end_; ++b) sum.add(*of_box(b), coordinate(B, b), 1.0);
  }

  /// The reciprocals of the next box enter, given by its powers of charges, and those of boxes that have left leave.
  ACSTUDY_ALWAYS_INLINE inline void enter_reciprocals(const double* powers) {
    reciprocals_.push(powers);
    drop_reciprocals();
  }
  ACSTUDY_ALWAYS_INLINE inline void drop_reciprocals() { reciprocals_.drop_before(begin_ - first_); }
  /// local[c * stride + n] += coefficients of sum charge row[c]/s, s in widths of a box, `gap` boxes after
  /// the last to enter.
  ACSTUDY_ALWAYS_INLINE inline void add_reciprocals(std::ptrdiff_t gap, double* local, int stride) {
    if (!reciprocals_.empty()) reciprocals_.add_to(static_cast<double>(gap), local, stride);
  }

 private:
  static constexpr std::ptrdiff_t polynomials_size = (sizeof(Polynomials) + 63) / 64 * 8;

  /// Where the center of box B is in the coordinate of box b.
  static double coordinate(std::ptrdiff_t B, std::ptrdiff_t b) { return 2.0 * static_cast<double>(B - b); }
  Polynomials* of_box(std::ptrdiff_t b) const {
    return reinterpret_cast<Polynomials*>(polynomials_ + (b - first_) % size_ * polynomials_size);
  }

  ACSTUDY_ALWAYS_INLINE inline void take_in(std::ptrdiff_t first, std::ptrdiff_t last, double center,
                                            Polynomials& polynomials, double* charge_powers) const {
    using Moment = typename C::Moment;
    constexpr int over_terms = Polynomials::over_terms, plain_terms = Polynomials::plain_terms;
    constexpr int vectors = padded(terms) / lane_count, over_vectors = Polynomials::over_width / lane_count,
                  plain_vectors = C::stride / lane_count;
    const double kappa = per_delta_ / boxes_.per_radius();
    Lanes powers_sum[C::over * vectors] = {};
    Lanes over_sum[over_terms * over_vectors + 1] = {}, plain_sum[plain_terms * plain_vectors + 1] = {};
    for (std::ptrdiff_t p = first; p < last; p += lane_count) {
      const Vector<s> vector = vector_of<s>(p, last);
      const Lanes tau = (vector.x(boxes_.order()) - center) * boxes_.per_radius();
      Lanes D[Moment::degree];
      moment_coefficients<Moment, piece>(vector.gap(boxes_.order()) * per_delta_, D);
      double taus[lane_count], charges[lane_count], over[over_terms + 1][lane_count],
          plain[plain_terms + 1][lane_count];
      store(taus, tau);
      store(charges, D[0]);
      // z = kappa (u - tau), with u the coordinate in the box.
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
        const double* const row = rows_ + s * (p + k) * C::stride;
        if constexpr (piece == KernelPiece::inside) charge_[p + k] = charges[lane];
        Lanes power[vectors];
        monomials<vectors>(taus[lane], power);
#pragma GCC unroll 4
        for (int c = 0; c < C::over; ++c) {
          const double charge = charges[lane] * row[c];
#pragma GCC unroll 16
          for (int v = 0; v < vectors; ++v) powers_sum[c * vectors + v] += power[v] * charge;
        }
#pragma GCC unroll 4
        for (int n = 0; n < over_terms; ++n) {
#pragma GCC unroll 4
          for (int v = 0; v < over_vectors; ++v) {
            over_sum[n * over_vectors + v] += load(row + v * lane_count) * over[n][lane];
          }
        }
#pragma GCC unroll 4
        for (int n = 0; n < plain_terms; ++n) {
#pragma GCC unroll 16
          for (int v = 0; v < plain_vectors; ++v) {
            plain_sum[n * plain_vectors + v] += load(row + v * lane_count) * plain[n][lane];
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

  const Boxes<s>& boxes_;
  std::ptrdiff_t first_, begin_, end_, size_;
  double per_delta_;
  const double* rows_;
  double* charge_;
  Reciprocals reciprocals_;
  double* polynomials_;  ///< of each box about its own center
};

/// In place of the outer window of a kernel that has one piece.
struct NoWindow {
  static constexpr std::ptrdiff_t begin() { return 0; }
  static constexpr std::ptrdiff_t end() { return 0; }
  template <class Polynomials>
  void add_to(std::ptrdiff_t, Polynomials&) const {}
  void add_reciprocals(std::ptrdiff_t, double*, int) {}
};

}  // namespace ACSTUDY_ISA
}  // namespace acstudy::far
