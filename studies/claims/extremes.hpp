#pragma once

/// @file
/// The table of extremes: what is to be expected at the ends of every range, and what is measured there.

#include <cstdint>
#include <vector>

#include "studies/cases/study.hpp"

namespace acstudy {

/// What the rows are measured on.
struct Extremes {
  std::vector<SchemeChoice> schemes;
  std::int64_t most_particles = 1'000'000;
  std::int64_t most_steps = 1'000'000;
  std::int64_t levels = 5;  ///< of N, where an order is measured
};

/// Every row for every scheme that it concerns. The statement of a finding is the extreme, its claim the expectation.
/// An expectation has findings that must hold, and negative controls: the same measurement of a scheme with a mistake,
/// or where the expectation has no reason to hold, which must be violated.
std::vector<Measurement> extreme_rows(const Extremes& extremes);

}  // namespace acstudy
