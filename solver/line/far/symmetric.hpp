#pragma once

/// @file
/// Model II at a cost per particle that does not grow with the number of neighbors.

#include <cstddef>
#include <cstdint>

#include "solver/line/far/far_sweeps.hpp"
#include "solver/line/far/side_sums.hpp"

namespace acstudy::far {
inline namespace ACSTUDY_ISA {

/// Of a particle, with m as in the vector form of Model II: sums over neighbors of |d| m, m/|d|, sign(k) b m and
/// sign(k) c_hat m, and the last kinds with u of the neighbor.
///
/// A velocity at a midpoint is a sum of products over the two particles, so that sums over neighbors are taken for each
/// mode and multiplied with what belongs to the particle at the end. Rows are the modes 1, C_1, S_1, C_2, ... times
/// each of 1, u of the local form, u of the nonlocal form; then the position.
template <bool local, bool nonlocal, int modes>
class FarSymmetric {
 public:
  FarSymmetric(const SweepRange& range, const SymmetricSweep& sweep, Memory& memory)
      : range_(range), sweep_(sweep), memory_(memory), origin_(range.x[(range.begin + range.end) / 2]) {
    c_hat_.add(sweep.c, +1.0);
    c_hat_.add(sweep.b, -1.0);
    b_.add(sweep.b, +1.0);
  }

  std::int64_t run() {
    const double* const rows = fill_rows();
    const std::ptrdiff_t size = range_.end - range_.begin + 2 * lane_count;
    double* const memory = memory_.one_side.reserve(size * kept) - range_.begin + lane_count;
    for (int k = 0; k < kept; ++k) left_[k] = memory + k * size;
    const std::ptrdiff_t begin = range_.begin, end = range_.end;
    const std::int64_t left_pairs =
        SideSums<+1, Sums>(range_, rows, memory_).run(begin, end, [&](const auto& vector, const auto& sums) {
          const Totals totals = totals_of(vector, sums, -1.0);
          // Lanes beyond the vector's count write what the next vector in walking order writes over.
          for (int k = 0; k < kept; ++k) store(left_[k] + vector.lowest_index(), totals.value[k]);
        });
    return left_pairs +
           SideSums<-1, Sums>(range_, rows, memory_).run(1 - end, 1 - begin, [&](const auto& vector, const auto& sums) {
             finish(vector, totals_of(vector, sums, +1.0));
           });
  }

 private:
  static constexpr int sets = 1 + (local ? 1 : 0) + (nonlocal ? 1 : 0);
  static constexpr int nonlocal_set = sets - 1;
  static constexpr int position = (1 + 2 * modes) * sets;
  using Sums = Channels<SplineMass, sets, position + 1, 16>;

  /// A field by all of the sweep's modes.
  struct Modes {
    double constant = 0.0, cosine[modes] = {}, sine[modes] = {};
    void add(const SweepField& field, double factor) {
      constant += factor * field.constant;
      for (int i = 0; i < field.modes; ++i) {
        cosine[field.mode[i]] += factor * field.cosine[i];
        sine[field.mode[i]] += factor * field.sine[i];
      }
    }
  };

  /// reach, moment, then for each set slope and c_hat, then b of the nonlocal form.
  static constexpr int kept = 2 + 2 * sets + (nonlocal ? 1 : 0);
  struct Totals {
    Lanes value[kept];
    Lanes& reach() { return value[0]; }
    Lanes& moment() { return value[1]; }
    Lanes& slope(int set) { return value[2 + 2 * set]; }
    Lanes& c_hat(int set) { return value[3 + 2 * set]; }
    Lanes& b() { return value[kept - 1]; }
  };

  const double* fill_rows() const {
    const auto [first, last] = sources_of(range_.x, range_.inside, range_.begin, range_.end);
    double* const rows = memory_.rows.reserve((last - first) * Sums::stride) - first * Sums::stride;
    for (std::ptrdiff_t j = first; j < last; ++j) {
      double* const row = rows + j * Sums::stride;
      row[0] = 1.0;
      if constexpr (local) row[1] = sweep_.local.u[j];
      if constexpr (nonlocal) row[nonlocal_set] = sweep_.nonlocal.u[j];
      for (int n = 0; n < modes; ++n) {
        for (int k = 0; k < sets; ++k) {
          row[(1 + 2 * n) * sets + k] = sweep_.half_cosine[n][j] * row[k];
          row[(2 + 2 * n) * sets + k] = sweep_.half_sine[n][j] * row[k];
        }
      }
      row[position] = sweep_.x[j] - origin_;
      for (int k = Sums::plain; k < Sums::stride; ++k) row[k] = 0.0;
    }
    return rows;
  }

  /// @param sign  of k on this side
  template <int s>
  ACSTUDY_ALWAYS_INLINE inline Totals totals_of(const Vector<s>& vector, const ChannelSums<Sums>& sums,
                                                double sign) const {
    Totals totals;
    totals.reach() = sums.reach;
    // |d| = s (x_j - x_i), both from the origin
    totals.moment() = s * ((vector.read(sweep_.x) - origin_) * sums.plain[0] - sums.plain[position]);
    Lanes c_hat[sets], b = b_.constant * sums.plain[0];
    for (int k = 0; k < sets; ++k) {
      totals.slope(k) = sums.over[k] * (1.0 / range_.delta);
      c_hat[k] = c_hat_.constant * sums.plain[k];
    }
    for (int n = 0; n < modes; ++n) {
      const Lanes C = vector.read(sweep_.half_cosine[n]), S = vector.read(sweep_.half_sine[n]);
      const Lanes* const of_C = sums.plain + (1 + 2 * n) * sets;
      const Lanes* const of_S = of_C + sets;
      const auto by = [&](const Modes& field, int k) ACSTUDY_ALWAYS_INLINE {
        return (field.cosine[n] * C + field.sine[n] * S) * of_C[k] +
               (field.sine[n] * C - field.cosine[n] * S) * of_S[k];
      };
      for (int k = 0; k < sets; ++k) c_hat[k] += by(c_hat_, k);
      if constexpr (nonlocal) b += by(b_, 0);
    }
    for (int k = 0; k < sets; ++k) totals.c_hat(k) = sign * c_hat[k];
    if constexpr (nonlocal) totals.b() = sign * b;
    return totals;
  }

  /// (3.8) and (3.10) with the sums taken apart.
  template <int s>
  ACSTUDY_ALWAYS_INLINE inline void finish(const Vector<s>& vector, Totals sum) const {
    const Lanes reach = max(max(sum.reach(), vector.read(left_[0])), spread(range_.delta));
    for (int k = 1; k < kept; ++k) sum.value[k] += vector.read(left_[k]);
    const Lanes per_moment = 1.0 / sum.moment(), viscosity = sweep_.mu * reach;
    if constexpr (local) {
      const Lanes u = vector.read(sweep_.local.u);
      const Lanes A = sum.c_hat(0) * u + sum.c_hat(1), D = sum.slope(1) - sum.slope(0) * u;
      vector.write((viscosity * D - A) * per_moment - vector.read(sweep_.b_prime) * u, sweep_.local.rate);
    }
    if constexpr (nonlocal) {
      const Lanes u = vector.read(sweep_.nonlocal.u);
      const Lanes A = sum.c_hat(0) * u + sum.c_hat(nonlocal_set), D = sum.slope(nonlocal_set) - sum.slope(0) * u;
      vector.write((viscosity * D - A - 2.0 * sum.b() * u) * per_moment, sweep_.nonlocal.rate);
    }
  }

  const SweepRange& range_;
  const SymmetricSweep& sweep_;
  Memory& memory_;
  Modes c_hat_, b_;
  double origin_;       ///< of positions in rows, near to all of them
  double* left_[kept];  ///< totals of the left side, by index
};

template <int modes>
std::int64_t symmetric_with(const SweepRange& range, const SymmetricSweep& sweep, Memory& memory) {
  const bool local = sweep.local.u != nullptr, nonlocal = sweep.nonlocal.u != nullptr;
  if (local && nonlocal) return FarSymmetric<true, true, modes>(range, sweep, memory).run();
  if (local) return FarSymmetric<true, false, modes>(range, sweep, memory).run();
  return FarSymmetric<false, true, modes>(range, sweep, memory).run();
}

inline std::int64_t symmetric_sweep(const SweepRange& range, const SymmetricSweep& sweep, Memory& memory) {
  int modes = 0;
  for (const SweepField* const field : {&sweep.c, &sweep.b}) {
    for (int i = 0; i < field->modes; ++i) modes = field->mode[i] < modes ? modes : field->mode[i] + 1;
  }
  return modes <= 2 ? symmetric_with<2>(range, sweep, memory) : symmetric_with<most_modes>(range, sweep, memory);
}

}  // namespace ACSTUDY_ISA
}  // namespace acstudy::far
