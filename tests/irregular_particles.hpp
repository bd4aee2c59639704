#pragma once

/// @file
/// Irregular particles, and their neighbors found by looking at every other particle.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "solver/line/particles.hpp"

namespace acstudy::test {

/// Increasing positions within one period whose gaps differ by up to a factor of `spread`.
inline std::vector<double> irregular_positions(std::size_t count, double period, unsigned seed, double spread = 5.0) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(1.0, spread);
  std::vector<double> gap(count), x(count);
  double sum = 0.0;
  for (double& value : gap) sum += value = uniform(generator);
  double position = -0.3 * period;
  for (std::size_t j = 0; j < count; ++j) {
    x[j] = position;
    position += gap[j] * period / sum;
  }
  return x;
}

/// Values in [-1, 1].
inline std::vector<double> irregular_values(std::size_t count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> u(count);
  for (double& value : u) value = uniform(generator);
  return u;
}

struct Neighbor {
  std::size_t index;  ///< 0 .. N-1
  double distance;    ///< > 0
};

/// The neighbors of particle j on one side (-1: left, +1: right), nearest first: those within delta, the nearest
/// always.
inline std::vector<Neighbor> neighbors(const std::vector<double>& x, double period, double delta, std::size_t j,
                                       int side) {
  std::vector<Neighbor> others;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i == j) continue;
    const double gap = side * (x[i] - x[j]);
    others.push_back({i, gap > 0.0 ? gap : gap + period});
  }
  std::sort(others.begin(), others.end(), [](auto a, auto b) { return a.distance < b.distance; });
  std::size_t inside = 0;
  while (inside < others.size() && others[inside].distance <= delta * (1.0 + 1e-11)) ++inside;
  others.resize(std::max<std::size_t>(inside, 1));
  return others;
}

struct Gaps {
  double smallest, largest;
};
inline Gaps gaps(const std::vector<double>& x, double period) {
  Gaps g{period - (x.back() - x.front()), period - (x.back() - x.front())};
  for (std::size_t j = 1; j < x.size(); ++j) {
    g.smallest = std::min(g.smallest, x[j] - x[j - 1]);
    g.largest = std::max(g.largest, x[j] - x[j - 1]);
  }
  return g;
}

inline Particles placed(const std::vector<double>& x, double period, double delta) {
  Particles particles(x.size(), period, delta);
  particles.place(x);
  return particles;
}

inline PeriodicArray periodic(const std::vector<double>& values) {
  PeriodicArray u(values.size());
  std::copy(values.begin(), values.end(), u.values().begin());
  return u;
}

/// Rates of a placed scheme.
template <class Scheme>
std::vector<double> rates(Scheme& scheme, const std::vector<double>& values) {
  PeriodicArray u = periodic(values);
  std::vector<double> du(values.size());
  scheme.rate(u, du);
  return du;
}

/// max |a - b| / max |b|.
inline double relative_gap(const std::vector<double>& a, const std::vector<double>& b) {
  double gap = 0.0, scale = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    gap = std::max(gap, std::isnan(a[i]) ? INFINITY : std::abs(a[i] - b[i]));
    scale = std::max(scale, std::abs(b[i]));
  }
  return gap / scale;
}

/// Largest row sum of |I + dt R|, R the matrix of the rates: the maximum norm of one forward Euler step.
template <class Scheme>
double step_norm(Scheme& scheme, std::size_t count, double dt) {
  std::vector<double> row_sum(count, 0.0), unit(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    unit[i] = 1.0;
    const std::vector<double> column = rates(scheme, unit);
    unit[i] = 0.0;
    for (std::size_t j = 0; j < count; ++j) row_sum[j] += std::abs((i == j ? 1.0 : 0.0) + dt * column[j]);
  }
  return *std::max_element(row_sum.begin(), row_sum.end());
}

}  // namespace acstudy::test
