#pragma once

/// @file
/// Which levels an order can be read from: the asymptotic window, an outlier, the weight of a single level.

#include <optional>

#include "reports/judging/fits.hpp"

namespace acstudy {

/// Indices of the first and the last level that count.
struct Window {
  std::size_t first, last;

  std::size_t size() const { return last - first + 1; }
};

/// Leaves out coarse levels that do not follow the law of the finer ones.
///
/// Of all windows that end at the finest level, the one under which the errors are the most probable: those inside
/// follow a corrected law but for scatter, those outside follow none. Fine levels are never left out: an error that
/// stops falling is a result. Four levels stay, or all if there are fewer, since a law of three parameters fits any
/// three.
Window asymptotic_window(LevelView levels);

/// A single coarse level that is off by a larger factor is not asymptotic, which nobody takes for scatter; one that is
/// off by a smaller one does not matter. In between it may be either.
inline constexpr double coarse_factor = 1.8, harmless_factor = 1.25;

/// A level that lies off the law of all others, and how far: log(error/law).
struct Outlier {
  std::size_t level;
  double deviation;
};

/// The level without which the sum of squares falls by far more than chance explains (F test at 0.2 % over all levels).
/// Four levels are compared with a power law, more with a corrected one; three tell nothing.
std::optional<Outlier> find_outlier(LevelView levels);

/// The largest change of the power law's order when one level is left out; signed; needs four levels.
struct LeaveOneOut {
  double change = not_estimated;
  std::size_t level = 0;
};

LeaveOneOut leave_one_out(LevelView levels);

}  // namespace acstudy
