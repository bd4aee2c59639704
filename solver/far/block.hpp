#pragma once

/// @file
/// Consecutive particles at once, and the order in which one side of them is walked.

#include <cstddef>

#include "solver/vector/lanes.hpp"

namespace acstudy::far {
inline namespace ACSTUDY_ISA {

/// Particles in the order in which a side is walked: p = s j increases, at positions s x_j. Neighbors have a smaller p,
/// whichever side they are on.
template <int s>
struct Order {
  const double* x_by_index;

  ACSTUDY_ALWAYS_INLINE inline double x(std::ptrdiff_t p) const { return s * x_by_index[s * p]; }
  ACSTUDY_ALWAYS_INLINE inline double gap(std::ptrdiff_t p) const { return x(p + 1) - x(p); }
};

/// Finds the outermost neighbors p of the particles start .. stop - 1 by two pointers, as find_windows() does: those at
/// a distance of at most `inside`, and the nearest always.
///
/// @return  the largest number of neighbors
template <int s>
std::ptrdiff_t find_outermost(Order<s> order, double inside, std::ptrdiff_t start, std::ptrdiff_t stop,
                              double* outermost) {
  std::ptrdiff_t widest = 1, i = start - 1;
  while (order.x(start) - order.x(i - 1) <= inside) --i;
  for (std::ptrdiff_t p = start; p < stop; ++p) {
    while (i < p - 1 && order.x(p) - order.x(i) > inside) ++i;
    outermost[p - start] = static_cast<double>(i);
    if (p - i > widest) widest = p - i;
  }
  return widest;
}

/// As many consecutive particles as there are lanes, or fewer; lanes that are left over repeat the last one.
template <int s>
class Block {
 public:
  /// @param outermost  that of the first, and those that follow
  ACSTUDY_ALWAYS_INLINE inline Block(Order<s> order, const double* outermost, std::ptrdiff_t first_,
                                     std::ptrdiff_t stop)
      : first(first_), count(stop - first_ < lane_count ? static_cast<int>(stop - first_) : lane_count) {
    x = static_cast<double>(s) * read(order.x_by_index);
    for (int lane = 0; lane < lane_count; ++lane) {
      p[lane] = static_cast<double>(at(lane));
      outer[lane] = outermost[at(lane) - first];
    }
    lowest = static_cast<std::ptrdiff_t>(outermost[0]);
    highest = static_cast<std::ptrdiff_t>(outermost[count - 1]);
  }

  std::ptrdiff_t first;  ///< p of the nearest to the neighbors
  int count;
  Lanes x;
  Lanes p;
  Lanes outer;                     ///< p of the outermost neighbor
  std::ptrdiff_t lowest, highest;  ///< of these

  /// Values of the lanes' particles in an array by index.
  ACSTUDY_ALWAYS_INLINE inline Lanes read(const double* values) const {
    if (count == lane_count) return load(values + lowest_index());
    Lanes lanes;
    for (int lane = 0; lane < lane_count; ++lane) lanes[lane] = values[s * at(lane)];
    return lanes;
  }
  ACSTUDY_ALWAYS_INLINE inline void write(Lanes lanes, double* values) const {
    if (count == lane_count) {
      store(values + lowest_index(), lanes);
    } else {
      for (int lane = 0; lane < lane_count; ++lane) values[s * at(lane)] = lanes[lane];
    }
  }

 private:
  /// Lanes lie in memory by increasing index, also where p decreases along them.
  std::ptrdiff_t lowest_index() const { return s > 0 ? first : -(first + lane_count - 1); }
  std::ptrdiff_t at(int lane) const {
    const int step = s > 0 ? lane : lane_count - 1 - lane;
    return first + (step < count ? step : count - 1);
  }
};

}  // namespace ACSTUDY_ISA
}  // namespace acstudy::far
