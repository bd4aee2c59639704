#include "solver/line/particles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace acstudy {

double inside_horizon(double delta, double first, double last, double period) {
  // The second term is for more than some 1e5 particles, where the round-off of positions exceeds the tolerance.
  const double largest = std::max(std::abs(first), std::abs(last) + period);
  return delta * (1.0 + horizon_tie_tolerance) + 4.0 * std::numeric_limits<double>::epsilon() * largest;
}

void find_windows(std::span<const double> x, double period, double delta, Windows& windows) {
  const std::ptrdiff_t n = std::ssize(x);
  const double inside = inside_horizon(delta, x.front(), x.back(), period);
  windows.left.resize(x.size());
  windows.right.resize(x.size());
  windows.widest = 1;

  std::ptrdiff_t end = 1;
  for (std::ptrdiff_t j = 0; j < n; ++j) {
    end = std::max(end, j + 1);
    while (end < j + n && (end < n ? x[end] : x[end - n] + period) - x[j] <= inside) ++end;
    windows.right[j] = static_cast<int>(std::max<std::ptrdiff_t>(end - 1 - j, 1));
    windows.widest = std::max(windows.widest, windows.right[j]);
  }

  std::ptrdiff_t first = -n;
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    while (first + windows.right[first < 0 ? first + n : first] < i) ++first;
    windows.left[i] = static_cast<int>(i - first);
    windows.widest = std::max(windows.widest, windows.left[i]);
  }
}

Particles::Particles(std::size_t count, double period_, double delta_) : x(count), period(period_), delta(delta_) {
  if (count < 3) throw std::invalid_argument("a periodic interval needs at least 3 particles");
  if (!std::isfinite(period) || period <= 0.0) throw std::invalid_argument("the period must be positive and finite");
  if (!(delta > 0.0 && delta < 0.5 * period)) {
    throw std::invalid_argument("the horizon must be positive and below half a period");
  }
}

void Particles::place(std::span<const double> positions) {
  const bool sorted = std::adjacent_find(positions.begin(), positions.end(),
                                         [](double a, double b) { return !(a < b); }) == positions.end();
  if (!sorted || !(positions.back() < positions.front() + period)) {
    throw std::domain_error("particles have crossed: positions no longer increase within one period");
  }
  std::copy(positions.begin(), positions.end(), x.values().begin());
  find_windows(positions, period, delta, windows);
  x.wrap(windows.widest, period);
}

std::vector<double> uniform_positions(std::size_t count, double period) {
  std::vector<double> x(count);
  for (std::size_t j = 0; j < count; ++j) x[j] = static_cast<double>(j) * period / static_cast<double>(count);
  return x;
}

}  // namespace acstudy
