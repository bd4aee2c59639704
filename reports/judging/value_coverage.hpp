#pragma once

/// @file
/// Do 95 % of the intervals of order and limit contain them? Measured on random series of values whose law is known.

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "reports/judging/value_fits.hpp"

namespace acstudy {

/// Series of one class and one number of levels.
struct ValueCoverageRow {
  std::string series;  ///< "power law": phi_0 + C v^p, or "two terms": phi_0 + C v^p (1 + D v^q)
  std::size_t levels, trials;
  std::size_t order_covered = 0, limit_covered = 0;  ///< intervals that contain p, and phi_0
};

using ValueLawOf = std::function<ValueLaw(std::span<const Value>)>;

/// Values whose errors are drawn as in `interval_coverage`: power laws of 4 to 8 levels; two terms of 5 to 8 levels, q
/// being 1/2, 1 or 2.
///
/// @param trials  per class and number of levels
/// @param law     the one that `judge_values` reports by default
std::vector<ValueCoverageRow> value_coverage(std::size_t trials, std::uint64_t seed);
std::vector<ValueCoverageRow> value_coverage(std::size_t trials, std::uint64_t seed, const ValueLawOf& law);

}  // namespace acstudy
