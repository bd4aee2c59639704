#pragma once

/// @file
/// Which theorem of the paper speaks about a series, and what it promises.

#include <string>

#include "studies/models/scheme_choice.hpp"

namespace acstudy {

/// What theory says of a series.
struct Theory {
  std::string variable;  ///< "h" or "max(h,delta)"
  double order;          ///< 0: the error does not vanish along this path
  std::string statement;
};

/// The theorem that speaks about a scheme: 2.6 - 2.8, 3.5 - 3.7; see Theorems. Its part (1) is the limit h -> 0 at a
/// fixed horizon, part (2) that of h and delta together.
std::string theorem(const SchemeChoice& scheme, bool standing);

/// Theory for a scheme along a path.
///
/// @param fixed_horizon  delta is the same at every level of the path
/// @param below_spacing  delta < h at the finest level
Theory theory_for(const SchemeChoice& scheme, bool standing, bool nonlocal_source, bool fixed_horizon,
                  bool below_spacing);

}  // namespace acstudy
