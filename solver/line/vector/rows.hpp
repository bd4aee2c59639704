#pragma once

/// @file
/// The rows of both models' matrices of rates for several particles at a time; see ModelI::matrix and ModelII::matrix.
///
/// Rows are for steps that are solved for, which take several times as long: one loop for all pieces of a kernel, and
/// few kernels with a loop of their own.

#include "solver/line/vector/midpoints.hpp"
#include "solver/line/vector/sweeps.hpp"
#include "solver/line/vector/walk.hpp"

namespace acstudy {
inline namespace ACSTUDY_ISA {

/// The rows of a vector of particles, written as the walks along their sides come to them.
class RowBlock {
 public:
  /// @param j  the first particle
  RowBlock(const SweepRows& rows, std::ptrdiff_t j)
      : rows_(rows), block_(rows.blocks == nullptr ? nullptr : rows.blocks + j / lane_count), center_(rows.value) {
    if (block_ == nullptr) return;
    center_ += (j / lane_count * (2 * rows.room + 1) + rows.room) * lane_count;
    store(center_, Lanes{});
  }

  /// Entries at an offset, once; each side from its first one outward.
  void add(std::ptrdiff_t offset, Lanes entries) const {
    if (block_ != nullptr && offset <= rows_.room && -offset <= rows_.room) store(at(offset), entries);
  }
  /// The block is complete, from offset -left to right.
  void close(std::ptrdiff_t left, std::ptrdiff_t right) const {
    if (block_ == nullptr) return;
    left = left < rows_.room ? left : rows_.room;
    right = right < rows_.room ? right : rows_.room;
    *block_ = {at(-left) - rows_.value, -left, left + right + 1};
  }
  /// Multiplies all entries.  @pre close() was called
  void scale(Lanes factor) const {
    if (block_ == nullptr) return;
    double* const first = rows_.value + block_->begin;
    for (std::ptrdiff_t k = 0; k < block_->width; ++k) {
      store(first + k * lane_count, load(first + k * lane_count) * factor);
    }
  }

 private:
  double* at(std::ptrdiff_t offset) const { return center_ + offset * lane_count; }

  const SweepRows& rows_;
  BandedMatrix::Block* block_;
  double* center_;
};

template <class K>
class UpwindRows {
 public:
  UpwindRows(const SweepRange& range, const UpwindSweep& sweep, const SweepRows& rows, K kernel)
      : range_(range), sweep_(sweep), rows_(rows), kernel_(kernel) {}

  /// @return the largest offset
  std::ptrdiff_t run() const {
    const Lanes inside = spread(range_.inside), none = spread(-1.0);
    std::ptrdiff_t widest = 0;
    for (std::ptrdiff_t j = range_.begin; j < range_.end; j += lane_count) {
      const Choice looks_right = at_most(load(sweep_.c_hat + j), Lanes{});
      const unsigned right = bits(looks_right);
      const RowBlock block(rows_, j);
      Sums l, r;
      if (right != all_bits) l = side<+1>(j, select(looks_right, none, inside), block, looks_right);
      if (right != 0) r = side<-1>(j, select(looks_right, inside, none), block, looks_right);
      block.close(l.neighbors, r.neighbors);
      const Lanes W = select(looks_right, r.W, l.W), s = select(looks_right, spread(-1.0), spread(1.0));
      const Lanes decay = s * load(sweep_.c_hat + j) * W;
      if (rows_.decay != nullptr) store(rows_.decay + j, decay);
      if (rows_.own_local != nullptr) store(rows_.own_local + j, -load(sweep_.b_prime + j) - decay);
      if (rows_.own_nonlocal != nullptr) {
        store(rows_.own_nonlocal + j, -s * (load(sweep_.c + j) * W - select(looks_right, r.b, l.b)));
      }
      widest = l.neighbors > widest ? l.neighbors : widest;
      widest = r.neighbors > widest ? r.neighbors : widest;
    }
    return widest;
  }

 private:
  struct Sums {
    Lanes W = {}, b = {};
    std::ptrdiff_t neighbors = 0;
  };

  /// The entries and sums of one side, zero in lanes that look to the other one.
  /// @param inside  negative for these
  template <int s>
  ACSTUDY_NEVER_INLINE Sums side(std::ptrdiff_t j, Lanes inside, const RowBlock& block, Choice looks_right) const {
    const Viewpoint from{load(range_.x + j), inside, range_.delta, 1.0 / range_.delta};
    Side<s, K> there(range_.x + j, from, all_bits, kernel_);
    const auto first_moment = [&]<KernelPiece piece>(Lanes z)
                                  ACSTUDY_ALWAYS_INLINE { return kernel_.template first_moment<piece>(z); };
    const bool with_b = rows_.own_nonlocal != nullptr;
    constexpr double sign = s;
    Sums sum;
    while (there.goes_on()) {
      const Neighbor neighbor = there.neighbor();
      const Lanes m = there.template step<KernelPiece::any>(first_moment) * K::moment_scale;
      const Lanes seen = s > 0 ? select(looks_right, Lanes{}, m) : select(looks_right, m, Lanes{});
      const Lanes W = seen / neighbor.distance;
      const std::ptrdiff_t i = j - s * neighbor.k;
      block.add(-s * neighbor.k, sign * (load(sweep_.c_hat + i) * W));
      sum.W += W;
      if (with_b) sum.b += W * load(sweep_.b + i);
    }
    sum.neighbors = there.neighbor().k - 1;
    return sum;
  }

  const SweepRange& range_;
  const UpwindSweep& sweep_;
  const SweepRows& rows_;
  K kernel_;
};

template <class Midpoints, class K>
class SymmetricRows {
 public:
  SymmetricRows(const SweepRange& range, const SymmetricSweep& sweep, const SweepRows& rows, K kernel)
      : range_(range), sweep_(sweep), rows_(rows), kernel_(kernel) {}

  /// @return the largest offset
  std::ptrdiff_t run() const {
    std::ptrdiff_t widest = 0;
    for (std::ptrdiff_t j = range_.begin; j < range_.end; j += lane_count) {
      const Viewpoint from{load(range_.x + j), spread(range_.inside), range_.delta, 1.0 / range_.delta};
      Side<+1, K> left(range_.x + j, from, all_bits, kernel_);
      Side<-1, K> right(range_.x + j, from, all_bits, kernel_);
      const Lanes reach = max(spread(range_.delta), max(left.neighbor().distance, right.neighbor().distance));
      const Lanes viscosity = sweep_.mu * reach;
      const Midpoints midpoints(sweep_, j);
      const RowBlock block(rows_, j);
      Sums sum;
      walk(left, j, viscosity, midpoints, block, sum);
      walk(right, j, viscosity, midpoints, block, sum);
      const std::ptrdiff_t lefts = left.neighbor().k - 1, rights = right.neighbor().k - 1;
      const Lanes per_moment = 1.0 / sum.moment;
      block.close(lefts, rights);
      block.scale(per_moment);
      // The sums of R have the transport with the sign of a neighbor's; see Symmetric::finish.
      if (rows_.decay != nullptr) store(rows_.decay + j, sum.viscous * per_moment);
      if (rows_.own_local != nullptr) {
        store(rows_.own_local + j, -(sum.viscous + sum.c_hat) * per_moment - load(sweep_.b_prime + j));
      }
      if (rows_.own_nonlocal != nullptr) {
        store(rows_.own_nonlocal + j, -(sum.viscous - sum.c_hat + 2.0 * sum.c) * per_moment);
      }
      widest = lefts > widest ? lefts : widest;
      widest = rights > widest ? rights : widest;
    }
    return widest;
  }

 private:
  /// Of |d| m, m mu reach/|d|, sign(k) c_hat m and sign(k) c m.
  struct Sums {
    Lanes moment = {}, viscous = {}, c_hat = {}, c = {};
  };

  template <int s>
  ACSTUDY_NEVER_INLINE void walk(Side<s, K>& side, std::ptrdiff_t j, Lanes viscosity, const Midpoints& midpoints,
                                 const RowBlock& block, Sums& sums) const {
    const auto mass = [&]<KernelPiece piece>(Lanes z) ACSTUDY_ALWAYS_INLINE { return kernel_.template mass<piece>(z); };
    constexpr double sign = -s;  // of k
    Sums sum = sums;
    while (side.goes_on()) {
      const Neighbor neighbor = side.neighbor();
      const Lanes m = side.template step<KernelPiece::any>(mass), viscous = m * viscosity / neighbor.distance;
      const auto [c_hat, c] = midpoints.at(j - s * neighbor.k, neighbor.x);
      const Lanes transport = sign * (m * c_hat);
      block.add(-s * neighbor.k, viscous - transport);
      sum.moment += neighbor.distance * m;
      sum.viscous += viscous;
      sum.c_hat += transport;
      sum.c += sign * (m * c);
    }
    sums = sum;
  }

  const SweepRange& range_;
  const SymmetricSweep& sweep_;
  const SweepRows& rows_;
  K kernel_;
};

inline std::ptrdiff_t upwind_rows(const SweepRange& range, const UpwindSweep& sweep, const SweepRows& rows) {
  const SweepKernel& kernel = sweep.kernel;
  if (kernel.form == SweepKernel::Form::cubic_spline) return UpwindRows(range, sweep, rows, CubicSplineLanes{}).run();
  return UpwindRows(range, sweep, rows, TableLanes(kernel)).run();
}

template <class K>
std::ptrdiff_t symmetric_rows_of(const SweepRange& range, const SymmetricSweep& sweep, const SweepRows& rows,
                                 K kernel) {
  if (sweep.panels.terms > 0) return SymmetricRows<PolynomialMidpoints, K>(range, sweep, rows, kernel).run();
  return SymmetricRows<ModalMidpoints<most_modes, most_modes>, K>(range, sweep, rows, kernel).run();
}

inline std::ptrdiff_t symmetric_rows(const SweepRange& range, const SymmetricSweep& sweep, const SweepRows& rows) {
  const SweepKernel& kernel = sweep.kernel;
  if (kernel.form == SweepKernel::Form::cubic_spline) return symmetric_rows_of(range, sweep, rows, CubicSplineLanes{});
  return symmetric_rows_of(range, sweep, rows, TableLanes(kernel));
}

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
