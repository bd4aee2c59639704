#pragma once

/// @file
/// What round-off makes of weights, renormalizations and gaps, against arithmetic of 50 digits.

#include <cstdint>
#include <vector>

#include "studies/cases/measurement.hpp"
#include "studies/cases/subject.hpp"
#include "studies/models/model_card.hpp"

namespace acstudy {

/// The weights that are examined: a model's with a kernel.
struct WeightsChoice {
  const ModelCard* model;
  KernelChoice kernel;
};

/// How the integral of a kernel over a cell is computed.
enum class CellForm {
  factored,    ///< as the schemes do
  difference,  ///< of the closed forms at both ends: the negative control
};

/// The most that weights and N_j may be off, relatively, given exact gaps.
inline constexpr double digits_bound = 1e-13;

/// The largest relative error of W over delta/h. Positions are dyadic, so that gaps are exact: all equal, or between
/// h/4 and 7h/4 with every seventh one 2^-20 h.
/// @param ratios  delta/h, 0 < delta/h <= 1e5; up to 16 particles are examined at each, one from 1000 on
Measurement round_off_of_weights(const WeightsChoice& choice, const std::vector<double>& ratios, CellForm form);

/// The same of N_j.  @pre the model is renormalized
Measurement round_off_of_renormalization(const WeightsChoice& choice, const std::vector<double>& ratios);

/// The largest relative error of the gaps that the flow of b = sin(x) gives N particles from the uniform start. With
/// p = e^t sin(x/2), q = cos(x/2) at the start x, the exact ones follow from
///
///     tan((x_{j+1} - x_j)/2) = e^t sin(h/2) / (q_j q_{j+1} + p_j p_{j+1}).
///
/// Positions carry the digits of a gap only so far: the bound is some ulps of the period relative to the smallest gap.
/// @pre b of the scene is sin(x) and its period 2 pi
Measurement round_off_of_gaps(const std::shared_ptr<const Scene>& scene, std::int64_t N,
                              const std::vector<double>& times);

}  // namespace acstudy
