#pragma once

/// @file
/// The controls that a study of kind "controls" can name: mistakes made on purpose, never offered as schemes.

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mms/source.hpp"
#include "studies/models/scheme.hpp"
#include "studies/models/scheme_choice.hpp"

namespace acstudy {

inline constexpr std::string_view misprinted_trajectories = "misprinted trajectories";

/// A mistake in scheme 1, the local divergence.
struct NamedControl {
  std::string_view name;
  int model;  ///< whose mistake it is; 0 for either
  std::string_view mistake;
};

inline constexpr std::array named_controls = {
    NamedControl{"SPH sum", 2, "kernel values times particle volumes, no viscosity"},
    NamedControl{"SPH sum with viscosity", 2, "kernel values times particle volumes"},
    NamedControl{"no tail weight", 1, "the outermost cell ends at its particle, not at the horizon"},
    NamedControl{"point quadrature", 1, "kernel values times gaps in the place of cell moments"},
    NamedControl{"downwind", 1, "looks to the side from which nothing comes"},
    NamedControl{"no nearest neighbor", 1, "an empty sum where no neighbor is within the horizon"},
    NamedControl{"no renormalization", 2, "1 in the place of N_j"},
    NamedControl{"no viscosity", 2, "0 in the place of mu"},
    NamedControl{"half viscosity", 2, "mu/2 in the place of mu"},
    NamedControl{"horizon as viscous factor", 2, "delta in the place of reach_j"},
    NamedControl{"half horizon as viscous factor", 2, "delta/2 in the place of reach_j"},
    NamedControl{"no divergence term", 0, "b' u is missing"},
    NamedControl{"absolute velocity", 0, "c in the place of c - b"},
    NamedControl{"source off by 1 %", 0, "1.01 f in the place of f"},
    NamedControl{misprinted_trajectories, 0, "tan(x/2) = 2 tan(x_0) e^t in the place of tan(x/2) = tan(x_0/2) e^t"},
};

/// The scheme of a choice whose `control` is not empty.
/// @param scene  outlives the scheme
/// @throws std::logic_error for a control that is none, or none of this model with local divergence
std::unique_ptr<Scheme> make_control(const SchemeChoice& choice, const Scene& scene, double mu);

/// The source that a control is given; `source` itself unless the source is its mistake.
std::unique_ptr<Source> make_control_source(std::string_view control, std::unique_ptr<Source> source);

/// x(t) = 2 arccot(exp(C - t)) with C = log(cot(x_0)/2), as the paper prints it for b = sin x. It obeys x' = b(x), but
/// x(0) is not x_0, and the particles of half a period cover the whole of it, so that order is lost.
extern const char* const misprinted_flow;

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
