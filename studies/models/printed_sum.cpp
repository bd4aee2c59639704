#include "studies/models/printed_sum.hpp"

#include <algorithm>

#include "solver/line/particles.hpp"

namespace acstudy {

std::vector<PrintedNeighbor> printed_neighbors(const PrintedAt& at, int s) {
  const auto& [scheme, scene, mu, x, u, delta, j] = at;
  const double period = scene.period();
  std::vector<PrintedNeighbor> near;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (const int turn : {-1, 0, 1}) {
      const double position = x[i] + turn * period, z = position - x[j];
      if (s * z < 0.0 && (turn != 0 || i != j)) near.push_back({z, position, u[i]});
    }
  }
  std::sort(near.begin(), near.end(),
            [](const PrintedNeighbor& a, const PrintedNeighbor& b) { return std::abs(a.z) < std::abs(b.z); });
  std::size_t count = 1;
  while (count < near.size() && std::abs(near[count].z) <= delta * (1.0 + horizon_tie_tolerance)) ++count;
  near.resize(count);
  return near;
}

}  // namespace acstudy
