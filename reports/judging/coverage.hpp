#pragma once

/// @file
/// Do 95 % of the reported intervals contain the true order? Measured on random series whose order is known.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "reports/judging/fits.hpp"

namespace acstudy {

/// Series of one class and one number of levels.
struct CoverageRow {
  std::string series;  ///< "power law": C v^p, or "two terms": C v^p (1 + D v^q)
  std::size_t levels;
  std::size_t trials;
  std::size_t covered;  ///< intervals that contain the true order
  double mean_width;    ///< of the interval, high - low

  double fraction() const { return static_cast<double>(covered) / static_cast<double>(trials); }
};

/// An interval for the order of a series.
using IntervalOf = std::function<Estimate(LevelView)>;

/// Errors C v^p, with and without a second term, times lognormal noise: 4 to 8 levels; order 1/2, 1, 2 or 3; ratios
/// between 1.4 and 2.4, each its own; D v^q between -0.6 and 1 at the coarsest level; noise between 0.1 % and 3 %.
///
/// q is hidden from the judge: 1, 1/2 and 2 are to be covered alike.
///
/// @param trials    per class and number of levels
/// @param interval  the one that `judge` reports by default
/// @param only      the class that is wanted; all are drawn, so its series are the same
/// @return a row per class and number of levels, the same in every call
std::vector<CoverageRow> interval_coverage(std::size_t trials, std::uint64_t seed, double q = 1.0,
                                           std::string_view only = "");
std::vector<CoverageRow> interval_coverage(std::size_t trials, std::uint64_t seed, const IntervalOf& interval,
                                           double q = 1.0, std::string_view only = "");

}  // namespace acstudy
