#pragma once

/// @file
/// The order in which one side of the particles is walked, and what is read and written along it.

#include <cstddef>

#include "solver/line/vector/lanes.hpp"

namespace acstudy::far {
inline namespace ACSTUDY_ISA {

/// Particles in the order in which a side is walked: p = s j increases, at positions s x_j. Neighbors have a smaller p,
/// whichever side they are on.
template <int s>
struct Order {
  const double* x_by_index;

  ACSTUDY_ALWAYS_INLINE inline double x(std::ptrdiff_t p) const { return s * x_by_index[s * p]; }
};

/// Consecutive particles p, as many as there are lanes, of which the first `count` are meant. The others are what
/// follows in memory.
///
/// Lanes lie in memory by increasing index, also where p decreases along them.
template <int s>
struct Vector {
  std::ptrdiff_t first;
  int count;

  ACSTUDY_ALWAYS_INLINE inline std::ptrdiff_t lowest_index() const { return s > 0 ? first : -(first + lane_count - 1); }
  /// The lane of particle first + i.
  static int lane(int i) { return s > 0 ? i : lane_count - 1 - i; }
  ACSTUDY_ALWAYS_INLINE inline Lanes p() const {
    Lanes p;
    for (int i = 0; i < lane_count; ++i) p[lane(i)] = static_cast<double>(first + i);
    return p;
  }
  ACSTUDY_ALWAYS_INLINE inline Lanes read(const double* by_index) const { return load(by_index + lowest_index()); }
  /// Positions in walking order.
  ACSTUDY_ALWAYS_INLINE inline Lanes x(Order<s> order) const { return s * read(order.x_by_index); }
  /// From each particle to the next.
  ACSTUDY_ALWAYS_INLINE inline Lanes gap(Order<s> order) const {
    return s * (read(order.x_by_index + s) - read(order.x_by_index));
  }
  /// Writes those that are meant.
  ACSTUDY_ALWAYS_INLINE inline void write(Lanes lanes, double* by_index) const {
    if (count == lane_count) {
      store(by_index + lowest_index(), lanes);
    } else {
      for (int i = 0; i < count; ++i) by_index[s * (first + i)] = lanes[lane(i)];
    }
  }
};

/// The next particles from p on, as many as there are before `stop`.
template <int s>
Vector<s> vector_of(std::ptrdiff_t p, std::ptrdiff_t stop) {
  return {p, stop - p < lane_count ? static_cast<int>(stop - p) : lane_count};
}

/// Particles by index: those of a range and all of their neighbors.
struct Sources {
  std::ptrdiff_t first, last;
};
inline Sources sources_of(const double* x, double inside, std::ptrdiff_t begin, std::ptrdiff_t end) {
  Sources sources{begin - 1, end + 1};
  while (x[begin] - x[sources.first - 1] <= inside) --sources.first;
  while (x[sources.last] - x[end - 1] <= inside) ++sources.last;
  return sources;
}

/// Finds the outermost neighbors p of the particles start .. stop - 1 by two pointers, as find_windows() does: those at
/// a distance of at most `inside`, and the nearest always.
///
/// @param outermost  by index
/// @return           number of neighbors
template <int s>
std::ptrdiff_t find_outermost(Order<s> order, double inside, std::ptrdiff_t start, std::ptrdiff_t stop,
                              double* outermost) {
  std::ptrdiff_t pairs = 0, i = start - 1;
  while (order.x(start) - order.x(i - 1) <= inside) --i;
  for (std::ptrdiff_t p = start; p < stop; ++p) {
    while (i < p - 1 && order.x(p) - order.x(i) > inside) ++i;
    outermost[s * p] = static_cast<double>(i);
    pairs += p - i;
  }
  return pairs;
}

}  // namespace ACSTUDY_ISA
}  // namespace acstudy::far
