#pragma once

/// @file
/// The walk of consecutive particles over their neighbors, all of them in step.

#include <type_traits>
#include <utility>

#include "solver/line/vector/kernels.hpp"
#include "solver/line/vector/lanes.hpp"
#include "solver/line/vector/table_lanes.hpp"

namespace acstudy {
inline namespace ACSTUDY_ISA {

/// Consecutive particles and what they see.
struct Viewpoint {
  Lanes x;
  Lanes inside;  ///< largest distance of a neighbor besides the nearest one; negative: there is no other
  double delta, per_delta;
};

/// A neighbor of each lane.
struct Neighbor {
  std::ptrdiff_t k;  ///< the k-th on its side
  Lanes x;
  Lanes distance;
};

/// The neighbors on one side, one after the other: neighbor k of lane l is x[l - s k], k = 1, 2, ...
template <int s>
class Distances {
 public:
  static constexpr int sign = s;

  /// @param x        at the first of the particles, readable as far as their windows reach, one beyond, and as far as
  /// is looked ahead
  /// @param counted  lanes whose neighbors are counted, a bit each
  ACSTUDY_ALWAYS_INLINE inline Distances(const double* x, const Viewpoint& from, unsigned counted)
      : x_(x), from_(from), counted_(counted), neighbor_{1, load(x - s), {}} {
    neighbor_.distance = distance_of(neighbor_.x);
  }

  /// Some lane has a neighbor k.
  bool goes_on() const { return lanes_ != 0; }
  /// Number of counted lanes that have.
  int count() const { return acstudy::count(lanes_ & counted_); }
  const Neighbor& neighbor() const { return neighbor_; }

  /// The next cells of all lanes, so many, end before z, in units of the horizon, and none of them is its lane's last.
  ACSTUDY_ALWAYS_INLINE inline bool ends_before(double z, int number = 1) const {
    return all_at_most(distance_of(load(x_ - s * (neighbor_.k + number))), spread(z * from_.delta));
  }
  /// The cells of all lanes begin at z or beyond.
  ACSTUDY_ALWAYS_INLINE inline bool begins_beyond(double z) const {
    return all_at_most(spread(z * from_.delta), distance_before_);
  }

  /// Steps from neighbor k to k + 1. @return where the cell of k ends, in units of the horizon
  template <KernelPiece piece>
  ACSTUDY_ALWAYS_INLINE inline Lanes end_of_cell() {
    const Lanes next = load_next(), next_distance = distance_of(next);
    Lanes z = neighbor_.distance * from_.per_delta;
    if constexpr (piece != KernelPiece::inside) {
      // The last cell ends at the horizon, beyond which a neighbor that ties with it may stand; all that follow are
      // empty.
      const Choice has_next = at_most(next_distance, from_.inside);
      z = select(has_next, min(z, spread(1.0)), spread(1.0));
      lanes_ = bits(has_next);
    }
    distance_before_ = neighbor_.distance;
    neighbor_ = {neighbor_.k + 1, next, next_distance};
    return z;
  }

 protected:
  /// Moment of a cell from that within its end. @return 0 in lanes that have no such neighbor
  ACSTUDY_ALWAYS_INLINE inline Lanes cell(Lanes moment_up_to) {
    return moment_up_to - std::exchange(moment_before_, moment_up_to);
  }

 private:
  ACSTUDY_ALWAYS_INLINE inline Lanes load_next() const { return load(x_ - s * (neighbor_.k + 1)); }
  ACSTUDY_ALWAYS_INLINE inline Lanes distance_of(Lanes neighbor) const {
    return s > 0 ? from_.x - neighbor : neighbor - from_.x;
  }

  const double* x_;
  const Viewpoint& from_;
  unsigned counted_, lanes_ = all_bits;
  Neighbor neighbor_;
  Lanes distance_before_ = {}, moment_before_ = {};
};

/// The same with the moments of a kernel.
template <int s, class K>
class Side : public Distances<s> {
 public:
  ACSTUDY_ALWAYS_INLINE inline Side(const double* x, const Viewpoint& from, unsigned counted, const K&)
      : Distances<s>(x, from, counted) {}

  /// Steps from neighbor k to k + 1. @return moment of the cell of k; 0 in lanes that have no neighbor k
  ///
  /// @param within  the kernel's moment up to z, for cells in this piece of it
  template <KernelPiece piece, class Within>
  ACSTUDY_ALWAYS_INLINE inline Lanes step(const Within& within) {
    return this->cell(within.template operator()<piece>(this->template end_of_cell<piece>()));
  }
};

/// Moments of several neighbors are looked up together. Some of them may be beyond the last one; their cells are empty.
template <int s>
class Side<s, TableLanes> : public Distances<s> {
 public:
  ACSTUDY_ALWAYS_INLINE inline Side(const double* x, const Viewpoint& from, unsigned counted, const TableLanes& kernel)
      : Distances<s>(x, from, counted), kernel_(kernel) {}

  /// The moments of the next neighbors, for as many steps. Where no step asks for others the compiler keeps them in
  /// registers.
  template <KernelPiece piece, int number>
  ACSTUDY_ALWAYS_INLINE inline void look_up() {
    Distances<s> ahead = *this;
    Lanes z[number], moment[number];
    for (int i = 0; i < number; ++i) z[i] = ahead.template end_of_cell<piece>();
    kernel_.moments(z, moment, piece_);
    for (int i = 0; i < number; ++i) moment_[i] = moment[i];
    next_ = 0;
    count_ = number;
  }

  template <KernelPiece piece, class Within>
  ACSTUDY_ALWAYS_INLINE inline Lanes step(const Within&) {
    if (next_ == count_) look_up<piece, 2>();
    this->template end_of_cell<piece>();
    return this->cell(moment_[next_++]);
  }

 private:
  const TableLanes& kernel_;
  std::ptrdiff_t piece_ = 0;
  int next_ = 0, count_ = 0;
  Lanes moment_[looked_ahead];
};

/// Calls add<piece>(side), which has to step, for all neighbors on each side. Sides go in step as far as both have
/// neighbors. K is the kernel of which `add` takes moments.
template <class K, class Add, class... Sides>
ACSTUDY_ALWAYS_INLINE inline void walk(const Add& add, Sides&... sides) {
  const auto each = [&]<KernelPiece piece>() ACSTUDY_ALWAYS_INLINE { (add.template operator()<piece>(sides), ...); };
  if constexpr (std::is_same_v<K, TableLanes>) {
    // Two lanes are those of processors of before 2013, for which less to compile is worth more.
    if constexpr (lane_count > 2) {
      static_assert(looked_ahead == 4);
      while ((sides.ends_before(1.0, looked_ahead) && ...)) {
        (sides.template look_up<KernelPiece::inside, looked_ahead>(), ...);
        each.template operator()<KernelPiece::inside>();
        each.template operator()<KernelPiece::inside>();
        each.template operator()<KernelPiece::inside>();
        each.template operator()<KernelPiece::inside>();
      }
    }
    while ((sides.goes_on() && ...)) {
      (sides.template look_up<KernelPiece::any, 2>(), ...);
      each.template operator()<KernelPiece::any>();
      each.template operator()<KernelPiece::any>();
    }
  } else {
    while ((sides.ends_before(K::breakpoint) && ...)) each.template operator()<KernelPiece::inside>();
    if constexpr (K::breakpoint < 1.0) {
      // Where few neighbors are inside, few are outside, and a loop of their own costs more than it saves.
      const double outside = ((sides.neighbor().k > 4) && ...) ? K::breakpoint : 2.0;
      while ((sides.goes_on() && ...) && !(sides.begins_beyond(outside) && ...))
        each.template operator()<KernelPiece::any>();
      while ((sides.goes_on() && ...)) each.template operator()<KernelPiece::outside>();
    } else {
      while ((sides.goes_on() && ...)) each.template operator()<KernelPiece::any>();
    }
  }
  if constexpr (sizeof...(sides) > 1) {
    const auto rest = [&](auto& side) ACSTUDY_ALWAYS_INLINE {
      while (side.goes_on()) add.template operator()<KernelPiece::any>(side);
    };
    (rest(sides), ...);
  }
}

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
