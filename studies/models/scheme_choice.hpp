#pragma once

/// @file
/// What a study chooses of a scheme.

#include <optional>
#include <string>

#include "studies/models/kernel_choice.hpp"

namespace acstudy {

struct SchemeChoice {
  int model;
  bool nonlocal_divergence;
  KernelChoice kernel;
  std::optional<double> mu;  ///< Model II; absent: max |c - b|
  std::string control;       ///< name of the mistake made on purpose; empty for the scheme itself
};

/// The largest forward Euler step at a smallest gap: h_min / max|c_hat| (Lemma 2.4), h_min / (2 mu) (Lemma 3.3).
inline double lemma_step(const SchemeChoice& scheme, double h_min, double max_c_hat, double mu) {
  return h_min / (scheme.model == 1 ? max_c_hat : 2.0 * mu);
}

/// "Model I, local divergence, inverse"; the divergence is left out where particles stand still.
std::string scheme_label(const SchemeChoice& scheme, bool standing);

}  // namespace acstudy
