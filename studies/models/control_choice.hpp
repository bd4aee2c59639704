#pragma once

/// @file
/// The controls that a study of kind "controls" can name: mistakes made on purpose, never offered as schemes.

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "mms/scene.hpp"
#include "solver/line/controls/velocity.hpp"
#include "studies/models/scheme_choice.hpp"

namespace acstudy {

class LineScheme;

/// A mistake in scheme 1, the local divergence: in the sums, in the velocities, in the source or in the trajectories.
struct Control {
  std::string_view name;
  const ModelCard* model;  ///< whose mistake it is; null for any
  std::string_view mistake;
  /// The scheme with the mistake in its sums; null where it has its own.  @param scene  outlives the scheme
  std::unique_ptr<LineScheme> (*make)(const SchemeChoice&, const Scene& scene, double mu) = nullptr;
  controls::Forgotten forgotten = controls::Forgotten::nothing;
  double source_factor = 1.0;
  const char* flow = nullptr;       ///< in the place of the scene's
  std::string_view flow_of_b = {};  ///< the b that it is a flow of
};

std::span<const Control> named_controls();
/// Null if there is none.
const Control* find_control(std::string_view name);

/// x(t) = 2 arccot(exp(C - t)) with C = log(cot(x_0)/2), as the paper prints it for b = sin x. It obeys x' = b(x), but
/// x(0) is not x_0, and the particles of half a period cover the whole of it, so that order is lost.
inline constexpr const char* misprinted_flow = "2*atan2(1, cos(x)/(2*sin(x))*exp(-t))";

/// Particles on the misprinted trajectories; a motion of `advance`.
class MisprintedParticles {
 public:
  MisprintedParticles(const Scene&, std::vector<double> start);
  bool moved_since(double t) {
    const bool moved = t != placed_at_;
    placed_at_ = t;
    return moved;
  }
  std::span<const double> at(double t);

 private:
  Expression flow_;
  std::vector<double> start_, x_;
  double placed_at_ = 0.0;
};

}  // namespace acstudy
