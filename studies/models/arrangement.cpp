#include "studies/models/arrangement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "solver/line/particles.hpp"

namespace acstudy {

std::string_view name_of(Arrangement arrangement) {
  constexpr std::string_view names[] = {"uniform", "moved", "jittered"};
  return names[static_cast<int>(arrangement)];
}

namespace {

/// Adds a random shift of at most `amplitude` h to every position.
void jitter(std::vector<double>& x, double h, double amplitude, unsigned seed) {
  // The generator's own bits: the distributions of the standard library differ between its implementations.
  std::mt19937_64 generator(seed);
  for (double& position : x) {
    const double random = static_cast<double>(generator() >> 11U) * 0x1p-53;
    position += h * (2.0 * amplitude * random - amplitude);
  }
}

}  // namespace

std::string Start::label() const {
  switch (kind) {
    case Kind::uniform:
      return "uniform";
    case Kind::jittered:
      return fmt::format("jittered({:g}, seed {})", smallest_gap, seed);
    case Kind::clustered:
      return fmt::format("clustered({:g})", smallest_gap);
  }
  return "";
}

std::vector<double> start_positions(const Start& start, std::size_t count, double period) {
  std::vector<double> x = uniform_positions(count, period);
  const double h = period / static_cast<double>(count);
  if (start.kind == Start::Kind::clustered) {
    const double wave = 2.0 * std::numbers::pi / period;
    // At the middle there is a particle, or the middle of a gap.
    const double slope = count % 2 == 0 ? std::sin(wave * h) / h : 2.0 * std::sin(0.5 * wave * h) / h;
    for (double& position : x) position += (1.0 - start.smallest_gap) / slope * std::sin(wave * position);
  } else if (start.kind == Start::Kind::jittered) {
    jitter(x, h, 0.5 * (1.0 - start.smallest_gap), start.seed);
    std::size_t closest = 1;
    for (std::size_t j = 2; j < count; ++j) {
      if (x[j] - x[j - 1] < x[closest] - x[closest - 1]) closest = j;
    }
    x[closest] = x[closest - 1] + start.smallest_gap * h;
  }
  return x;
}

std::vector<double> arrange(Arrangement arrangement, const Scene& scene, std::size_t count, unsigned seed) {
  std::vector<double> x = uniform_positions(count, scene.period());
  if (arrangement == Arrangement::moved) {
    Trajectories trajectories(scene, x);
    const auto moved = trajectories.at(scene.T());
    x.assign(moved.begin(), moved.end());
  } else if (arrangement == Arrangement::jittered) {
    jitter(x, scene.period() / static_cast<double>(count), 0.25, seed);
  }
  return x;
}

Gaps gaps(const std::vector<double>& x, double period) {
  const double across = x.front() + period - x.back();
  Gaps result{across, across};
  for (std::size_t j = 1; j < x.size(); ++j) {
    result.largest = std::max(result.largest, x[j] - x[j - 1]);
    result.smallest = std::min(result.smallest, x[j] - x[j - 1]);
  }
  return result;
}

}  // namespace acstudy
