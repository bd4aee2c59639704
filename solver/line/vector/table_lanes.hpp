#pragma once

/// @file
/// Moments from a table, for several neighbors at a time.

#include "solver/line/vector/lanes.hpp"
#include "solver/line/vector/sweeps.hpp"

namespace acstudy {
inline namespace ACSTUDY_ISA {

/// Any kernel, by a table of the moment that a sweep asks for. Several neighbors read its coefficients together, and
/// their polynomials do not wait for each other.
class TableLanes {
 public:
  explicit TableLanes(const SweepKernel& kernel) : kernel_(kernel), table_(kernel.moments) {}

  static constexpr double moment_scale = 1.0;

  /// moment[k] = the moment within z[k].  @pre ascending in each lane, 0 < z <= 1
  /// @param piece  one that no lane is before; becomes the last such
  template <int number>
  ACSTUDY_ALWAYS_INLINE inline void moments(const Lanes (&z)[number], Lanes (&moment)[number],
                                            std::ptrdiff_t& piece) const {
    const std::ptrdiff_t last = table_.count - 1;
    while (piece < last && all_at_most(spread(table_.pieces[piece].end), z[0])) ++piece;
    evaluate(piece, z, moment);
    if (piece < last && bits(at_most(spread(table_.pieces[piece].end), z[number - 1])) != 0) {
      Lanes there[number], values[number];
      for (int i = 0; i < number; ++i) {
        there[i] = z[i];
        values[i] = moment[i];
      }
      go_on<number>(piece + 1, there, values);
      for (int i = 0; i < number; ++i) moment[i] = values[i];
    }
  }

 private:
  /// The same of lanes that are in `piece` or beyond it.
  template <int number>
  ACSTUDY_NEVER_INLINE void go_on(std::ptrdiff_t piece, const Lanes* z, Lanes* moment) const {
    Lanes there[number], value[number];
    for (int i = 0; i < number; ++i) there[i] = z[i];
    for (; piece < table_.count; ++piece) {
      const Lanes bound = spread(table_.pieces[piece].begin);
      if (bits(at_most(bound, there[number - 1])) == 0) return;
      evaluate(piece, there, value);
      for (int i = 0; i < number; ++i) moment[i] = select(at_most(bound, there[i]), value[i], moment[i]);
    }
  }

  /// MomentTable::at() of all lanes.
  template <int number>
  ACSTUDY_ALWAYS_INLINE inline void evaluate(std::ptrdiff_t piece, const Lanes (&z)[number],
                                             Lanes (&value)[number]) const {
    if (piece == 0 && table_.power < 0) {
      for (int i = 0; i < number; ++i) value[i] = one_by_one(z[i]);
      return;
    }
    const MomentTable::Piece& polynomial = table_.pieces[piece];
    const double* const c = polynomial.coefficient;
    std::ptrdiff_t k = polynomial.terms - 1;
    const Lanes origin = spread(polynomial.origin), highest = spread(c[k]);
    Lanes t[number];
    if (table_.squared) {
      for (int i = 0; i < number; ++i) t[i] = z[i] * z[i] - origin;
    } else {
      for (int i = 0; i < number; ++i) t[i] = z[i] - origin;
    }
    for (int i = 0; i < number; ++i) value[i] = highest;
    if (number < looked_ahead && k > 4) {
      // Few of them wait for each product: Horner's rule in t^2, for an even number of terms.
      for (int i = 0; i < number; ++i) value[i] = value[i] * t[i] + c[k - 1];
      while ((k -= 2) > 0) {
        const Lanes upper = spread(c[k]), lower = spread(c[k - 1]);
        for (int i = 0; i < number; ++i) value[i] = value[i] * (t[i] * t[i]) + (upper * t[i] + lower);
      }
    }
    while (k-- > 0) {
      const Lanes next = spread(c[k]);
      for (int i = 0; i < number; ++i) value[i] = value[i] * t[i] + next;
    }
    if (piece > 0) return;
    if (table_.root) {
      for (int i = 0; i < number; ++i) value[i] *= sqrt(z[i]);
    }
    if ((table_.power & 1) != 0) {
      for (int i = 0; i < number; ++i) value[i] *= z[i];
    }
    if ((table_.power & 2) != 0) {
      for (int i = 0; i < number; ++i) value[i] *= z[i] * z[i];
    }
    for (int n = 4; n <= table_.power; n += 4) {
      for (int i = 0; i < number; ++i) value[i] *= z[i] * z[i] * (z[i] * z[i]);
    }
  }

  /// The function is compiled with the rest of the program, for any processor.
  ACSTUDY_NEVER_INLINE Lanes one_by_one(Lanes z) const {
    Lanes result = {};
    for (int i = 0; i < lane_count; ++i) result[i] = kernel_.moment(kernel_.kernel, z[i]);
    return result;
  }

  const SweepKernel& kernel_;
  const MomentTable::View table_;
};

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
