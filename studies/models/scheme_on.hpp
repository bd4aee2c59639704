#pragma once

/// @file
/// A model of the solver, with the velocities that it is to see, as a Scheme.

#include <memory>
#include <type_traits>
#include <utility>

#include "solver/line/controls/velocity.hpp"
#include "solver/line/scheme.hpp"
#include "studies/models/control_choice.hpp"
#include "studies/models/scheme.hpp"

namespace acstudy {

template <RateSum Model>
Stencil stencil_of(const Model& scheme, std::ptrdiff_t j, const Windows& windows) {
  const auto weights = scheme.weights(j);
  Stencil stencil{{}, {weights.begin(), weights.end()}};
  if constexpr (SeesOneSide<Model>) {
    const std::ptrdiff_t s = scheme.looks_left(j) ? +1 : -1;
    for (std::ptrdiff_t k = 1; k <= std::ssize(weights); ++k) stencil.offset.push_back(-s * k);
  } else {
    stencil.renormalization = scheme.renormalization(j);
    std::ptrdiff_t left = windows.left[j];
    if constexpr (requires { scheme.neighbors_left(j); }) left = scheme.neighbors_left(j);
    for (std::ptrdiff_t k = -left; k <= std::ssize(weights) - left; ++k) {
      if (k != 0) stencil.offset.push_back(k);
    }
  }
  return stencil;
}

/// @pre the scene outlives it
template <RateSum Model>
class SchemeOn final : public LineScheme {
 public:
  SchemeOn(Model model, const Scene& scene, controls::Forgotten forgotten)
      : model_(std::move(model)), velocity_{scene, forgotten} {}
  void place(const Particles& particles) override {
    windows_ = &particles.windows;
    model_.place(particles, velocity_);
  }
  void rate(PeriodicArray& u, std::span<double> du) override { model_.rate(u, du); }
  Stencil stencil(std::ptrdiff_t j) const override { return stencil_of(model_, j, *windows_); }
  std::span<const double> volumes() const override {
    if constexpr (requires { Model::carries_volumes; }) {
      if (Model::carries_volumes) return model_.volumes();
    }
    return {};
  }
  std::ptrdiff_t reach() const override {
    if constexpr (requires { model_.reach(); }) return model_.reach();
    return windows_->widest;
  }
  const SchemeRows* rows() const override {
    if constexpr (KnowsItsRows<Model>) return &rows_;
    return nullptr;
  }
  WorkCounts work() const override { return model_.work(); }

 private:
  struct NoRows {
    explicit NoRows(const Model&) {}
  };
  struct Rows final : SchemeRows {
    explicit Rows(const Model& its) : model(its) {}
    void matrix(RateMatrix& R) const override { model.matrix(R); }
    double strongest_decay() const override { return model.strongest_decay(); }
    const Model& model;
  };

  Model model_;
  controls::ForgetfulVelocity<Scene> velocity_;
  const Windows* windows_ = nullptr;
  std::conditional_t<KnowsItsRows<Model>, Rows, NoRows> rows_{model_};
};

/// A scheme on a scene, with the velocities that the choice's control leaves it.
template <RateSum Model>
std::unique_ptr<LineScheme> on(Model model, const SchemeChoice& choice, const Scene& scene) {
  const auto forgotten = choice.control != nullptr ? choice.control->forgotten : controls::Forgotten::nothing;
  return std::make_unique<SchemeOn<Model>>(std::move(model), scene, forgotten);
}

/// A control's own sum.
template <RateSum Model>
std::unique_ptr<LineScheme> wrong_sum_on(Model model, const Scene& scene) {
  return std::make_unique<SchemeOn<Model>>(std::move(model), scene, controls::Forgotten::nothing);
}

/// The scheme that `make(kernel, divergence)` makes of a kernel and the divergence of a choice, as types.
template <class Make>
auto with_divergence(const SchemeChoice& choice, const Scene& scene, const Make& make) {
  return [&](const auto& kernel) -> std::unique_ptr<LineScheme> {
    if (scene.standing()) return make(kernel, NoDivergence{});
    if (choice.nonlocal_divergence) return make(kernel, NonlocalDivergence{});
    return make(kernel, LocalDivergence{});
  };
}

/// The same of a control, which is one of the local divergence.
template <class Make>
auto with_local_divergence(const Scene& scene, const Make& make) {
  return [&](const auto& kernel) -> std::unique_ptr<LineScheme> {
    if (scene.standing()) return make(kernel, NoDivergence{});
    return make(kernel, LocalDivergence{});
  };
}

}  // namespace acstudy
