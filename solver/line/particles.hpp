#pragma once

/// @file
/// Particles on a periodic interval and the windows through which a scheme sees its neighbors.

#include <cassert>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <memory>
#include <new>
#include <span>
#include <utility>
#include <vector>

namespace acstudy {

/// Memory that reads as zero and costs nothing until it is used: of large arrays most of the room for ghosts never is.
template <class T>
struct UntouchedZeros {
  using value_type = T;
  UntouchedZeros() = default;
  template <class Other>
  UntouchedZeros(const UntouchedZeros<Other>&) {}
  T* allocate(std::size_t count) {
    if (void* const memory = std::calloc(count, sizeof(T))) return static_cast<T*>(memory);
    throw std::bad_alloc();
  }
  void deallocate(T* memory, std::size_t) { std::free(memory); }
  void construct(T*) {}
  template <class... Values>
  void construct(T* place, Values&&... values) {
    std::construct_at(place, std::forward<Values>(values)...);
  }
  bool operator==(const UntouchedZeros&) const = default;
};

using ZeroedVector = std::vector<double, UntouchedZeros<double>>;

/// Values at the particles j = 0 .. N-1, readable at j - k and j + k after `wrap(k)`.
///
/// A neighbor sum then runs over consecutive memory: ghosts cost 2k copies once, an index modulo N would cost every
/// pair.
class PeriodicArray {
 public:
  explicit PeriodicArray(std::size_t size = 0)
      : size_(size), margin_(size + vector_margin), values_(size + 2 * margin_) {}

  std::size_t size() const { return size_; }
  double operator[](std::ptrdiff_t j) const { return values_[static_cast<std::size_t>(j + margin())]; }
  double& operator[](std::ptrdiff_t j) { return values_[static_cast<std::size_t>(j + margin())]; }

  /// Pointer to entry j; valid for reading at offsets up to the wrapped reach.
  const double* at(std::ptrdiff_t j) const { return values_.data() + margin_ + j; }

  std::span<const double> values() const { return {values_.data() + margin_, size_}; }
  std::span<double> values() { return {values_.data() + margin_, size_}; }

  /// Ghosts that there is room for on each side.
  std::ptrdiff_t margin() const { return static_cast<std::ptrdiff_t>(margin_); }

  /// Makes entries -reach .. -1 and N .. N+reach-1 the periodic images; `period` is added per turn (0 for fields).
  /// @pre reach <= margin()
  void wrap(std::ptrdiff_t reach, double period = 0.0) {
    wrap_with(
        reach, [period](double value) { return value + period; }, [period](double value) { return value - period; });
  }
  /// The same for values that change sign with every period, such as those of cos(x/2).
  void wrap_alternating(std::ptrdiff_t reach) { wrap_with(reach, std::negate<double>(), std::negate<double>()); }

 private:
  /// Sums over several particles at a time read up to a vector more at either end.
  static constexpr std::size_t vector_margin = 24;

  template <class Later, class Earlier>
  void wrap_with(std::ptrdiff_t reach, Later later, Earlier earlier) {
    const std::ptrdiff_t n = std::ssize(*this);
    assert(reach <= margin());
    // One end after the other: either is a plain loop over consecutive memory.
    double* const first = values_.data() + margin_;
    for (std::ptrdiff_t k = 0; k < reach; ++k) first[n + k] = later(first[k]);
    for (std::ptrdiff_t k = 1; k <= reach; ++k) first[-k] = earlier(first[n - k]);
  }

  std::size_t size_, margin_;
  ZeroedVector values_;
};

/// How many neighbors each particle sees: l_j to its left and r_j to its right, each at least one.
struct Windows {
  std::vector<int> left, right;
  int widest = 0;
};

/// A neighbor at exactly the horizon is inside; round-off in a position must not decide.
inline constexpr double horizon_tie_tolerance = 1e-11;

/// The largest distance at which a neighbor is inside, for particles from `first` to `last` within one period.
double inside_horizon(double delta, double first, double last, double period);

/// Windows of sorted particles by two pointers, O(N).
///
/// The left windows are read off the right ones, so that i sees j exactly when j sees i, ties included.
/// @param x       positions, x_0 < ... < x_{N-1} < x_0 + period, N >= 3
/// @param delta   horizon, 0 < delta < period / 2
void find_windows(std::span<const double> x, double period, double delta, Windows& windows);

/// Particles at one instant.
struct Particles {
  /// @throws std::invalid_argument unless count >= 3, period > 0 and 0 < delta < period / 2 (all finite).
  Particles(std::size_t count, double period, double delta);

  std::size_t size() const { return x.size(); }

  /// Accepts new positions: finds the windows and wraps the positions as far as they reach.
  /// @throws std::domain_error if the positions are not strictly increasing within one period.
  void place(std::span<const double> positions);

  PeriodicArray x;
  double period;
  double delta;
  Windows windows;
};

/// Positions x_j = j period / N of the uniform start.
std::vector<double> uniform_positions(std::size_t count, double period);

}  // namespace acstudy
