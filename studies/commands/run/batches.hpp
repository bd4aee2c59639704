#pragma once

/// @file
/// Which cases are run together.

#include <cstddef>
#include <span>
#include <vector>

#include "studies/running/plan.hpp"

namespace acstudy {

/// Cases that one call of `run_cases` does: some on the same particles together, or one by itself.
struct Batch {
  std::vector<std::size_t> cases;  ///< indices of plans
  double work = 0.0;               ///< sum of `Case::estimated_work`
};

/// Batches as large as they can be, so that as little as possible is computed twice, and small enough for the workers
/// to end at about the same time. Heaviest batch first.
std::vector<Batch> batches_of(std::span<const Plan> plans, int workers);

/// The cases with the indices `which` in batches of at most so much work, or of those that share their sums over pairs.
/// Heaviest batch first.
std::vector<Batch> batches_up_to(double most, std::span<const Plan> plans, std::span<const std::size_t> which);

}  // namespace acstudy
