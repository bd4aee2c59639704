#pragma once

/// @file
/// What a study chooses of a scheme.

#include <memory>
#include <optional>
#include <string>

#include "studies/models/kernel_choice.hpp"
#include "studies/models/model_card.hpp"

namespace acstudy {

struct Control;
struct OutsideProgram;

struct SchemeChoice {
  const ModelCard* model;
  bool nonlocal_divergence;
  KernelChoice kernel;
  std::optional<double> mu;          ///< of a viscous model; absent: max |c - b|
  const Control* control = nullptr;  ///< the mistake made on purpose; null for the scheme itself
  /// What runs the cases in place of acstudy; then `model` is `outside_model`, and there is no kernel. Null: nothing.
  std::shared_ptr<const OutsideProgram> program = nullptr;
};

/// "Model I, local divergence, inverse"; the divergence is left out where particles stand still. Of a
/// program its label.
std::string scheme_label(const SchemeChoice& scheme, bool standing);

}  // namespace acstudy
