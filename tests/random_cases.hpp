#pragma once

/// @file
/// Scenes with random velocities, and cases on any scene.

#include <initializer_list>
#include <memory>
#include <random>
#include <string>

#include "studies/models/scheme.hpp"
#include "studies/running/run_case.hpp"

namespace acstudy::test {

/// sum of a few modes with random coefficients
inline std::string random_field(std::mt19937& generator, std::initializer_list<int> modes) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::string text = std::to_string(uniform(generator));
  for (const int n : modes) {
    text += " + " + std::to_string(uniform(generator)) + "*sin(" + std::to_string(n) + "*x)";
    text += " + " + std::to_string(uniform(generator)) + "*cos(" + std::to_string(n) + "*x)";
  }
  return text;
}

inline std::shared_ptr<const Scene> random_scene(unsigned seed) {
  std::mt19937 generator(seed);
  const std::string c = random_field(generator, {1, 3}), b = random_field(generator, {1, 2});
  return std::make_shared<const Scene>(
      SceneText{.name = {}, .period = "2*pi", .T = "1", .c = c, .b = b, .u = "cos(x - t)", .flow = {}});
}

/// A case of the local source, ten steps long.
inline Case case_on(const std::shared_ptr<const Scene>& scene, int model, bool nonlocal, const KernelChoice& kernel,
                    std::size_t N, double delta) {
  return {.scene = scene,
          .scheme = {find_model(model), nonlocal, kernel, {}, {}},
          .mu = model == 2 ? 2.5 : 0.0,
          .nonlocal_source = false,
          .source_rule = SourceRule::gauss,
          .integrator = &forward_euler,
          .N = static_cast<std::int64_t>(N),
          .h = scene->period() / static_cast<double>(N),
          .delta = delta,
          .dt = 1e-3,
          .steps = 10};
}

}  // namespace acstudy::test
