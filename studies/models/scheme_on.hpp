#pragma once

/// @file
/// A model of the solver, with the velocities that it is to see, as a Scheme.

#include <memory>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "studies/models/scheme.hpp"

namespace acstudy {

template <class Model>
Stencil stencil_of(const Model& scheme, std::ptrdiff_t j, const Windows& windows) {
  const auto weights = scheme.weights(j);
  Stencil stencil{{}, {weights.begin(), weights.end()}};
  if constexpr (requires { scheme.looks_left(j); }) {
    const std::ptrdiff_t s = scheme.looks_left(j) ? +1 : -1;
    for (std::ptrdiff_t k = 1; k <= std::ssize(weights); ++k) stencil.offset.push_back(-s * k);
  } else {
    stencil.renormalization = scheme.renormalization(j);
    for (std::ptrdiff_t k = -windows.left[j]; k <= windows.right[j]; ++k) {
      if (k != 0) stencil.offset.push_back(k);
    }
  }
  return stencil;
}

/// @tparam Velocity  `const Scene&`, or a velocity of its own that refers to the scene
template <class Model, class Velocity>
class SchemeOn final : public Scheme {
 public:
  SchemeOn(Model model, Velocity velocity) : model_(std::move(model)), velocity_(velocity) {}
  void place(const Particles& particles) override {
    windows_ = &particles.windows;
    model_.place(particles, velocity_);
  }
  void rate(PeriodicArray& u, std::span<double> du) override { model_.rate(u, du); }
  Stencil stencil(std::ptrdiff_t j) const override { return stencil_of(model_, j, *windows_); }
  void matrix(RateMatrix& R) const override {
    if constexpr (requires { model_.matrix(R); }) {
      model_.matrix(R);
    } else {
      throw std::logic_error("a control has no matrix");
    }
  }
  double strongest_decay() const override {
    if constexpr (requires { model_.strongest_decay(); }) {
      return model_.strongest_decay();
    } else {
      throw std::logic_error("a control has no bound on its steps");
    }
  }
  WorkCounts work() const override { return model_.work(); }

 private:
  Model model_;
  Velocity velocity_;
  const Windows* windows_ = nullptr;
};

template <class Model>
std::unique_ptr<Scheme> on(Model model, const Scene& scene) {
  return std::make_unique<SchemeOn<Model, const Scene&>>(std::move(model), scene);
}

/// The scheme that `make(kernel, divergence)` makes of the kernel and the divergence of a choice, as types.
template <class Make>
std::unique_ptr<Scheme> with_kernel_and_divergence(const SchemeChoice& choice, const Scene& scene, Make&& make) {
  return with_kernel(choice.kernel, [&](const auto& kernel) -> std::unique_ptr<Scheme> {
    if (scene.standing()) return make(kernel, NoDivergence{});
    if (choice.nonlocal_divergence) return make(kernel, NonlocalDivergence{});
    return make(kernel, LocalDivergence{});
  });
}

}  // namespace acstudy
