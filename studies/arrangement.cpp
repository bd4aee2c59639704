#include "studies/arrangement.hpp"

#include <algorithm>
#include <random>

#include "solver/particles.hpp"

namespace acstudy {

std::string_view name_of(Arrangement arrangement) {
  constexpr std::string_view names[] = {"uniform", "moved", "jittered"};
  return names[static_cast<int>(arrangement)];
}

std::vector<double> arrange(Arrangement arrangement, const Scene& scene, std::size_t count, unsigned seed) {
  std::vector<double> x = uniform_positions(count, scene.period());
  if (arrangement == Arrangement::moved) {
    Trajectories trajectories(scene, x);
    const auto moved = trajectories.at(scene.T());
    x.assign(moved.begin(), moved.end());
  } else if (arrangement == Arrangement::jittered) {
    const double h = scene.period() / static_cast<double>(count);
    // The generator's own bits: the distributions of the standard library differ between its implementations.
    std::mt19937_64 generator(seed);
    for (double& position : x) position += h * (0.5 * static_cast<double>(generator() >> 11U) * 0x1p-53 - 0.25);
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
