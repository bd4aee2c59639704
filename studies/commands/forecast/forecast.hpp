#pragma once

/// @file
/// What studies will take: time and memory.

#include <optional>
#include <span>
#include <vector>

#include "studies/cases/study.hpp"
#include "studies/commands/forecast/speeds.hpp"

namespace acstudy {

/// A case before it is run.
struct CaseForecast {
  Plan plan;
  std::optional<double> seconds;  ///< of a processor; none of a program
  double bytes;                   ///< while it runs, with its result
};

struct SeriesForecast {
  const Series* series;
  std::vector<CaseForecast> cases;  ///< as in the series

  /// Of all cases of which they are known.
  double seconds() const;
  /// While its largest case runs and the results of the others are kept.
  double bytes() const;
};

struct StudyForecast {
  const Study* study;
  std::vector<SeriesForecast> series;

  double seconds() const;
  double bytes() const;
};

/// Of all cases that there may be, none of which is taken from the store, and each as if it were run by itself.
StudyForecast forecast(const Study& study, Speeds& speeds);

/// Bytes of memory that this process may have.
double available_memory();

/// Refuses studies that no run can end well of.
/// @throws InputError at the level that needs the most, if a study needs more memory than there is
void require_memory(std::span<const Study> studies);

}  // namespace acstudy
