#pragma once

/// @file
/// The rate of one particle, summed as the formulas are printed: what the schemes are recomputed by.

#include <vector>

#include "studies/cases/subject.hpp"

namespace acstudy {

/// A sum and the sum of its terms' absolute values, with |c| + |b| in the place of |c_hat|: round-off is a few ulps of
/// the latter.
struct PrintedRate {
  double value, size;
};

/// rate_j(u) of (2.4), (2.9), (2.11), (3.6), (3.8) or (3.10); shares the kernels' closed forms with the solver, and
/// nothing else.  Searches all particles for the neighbors, O(N).
/// @param x, u  positions, increasing within one period, and values, shape [N]
PrintedRate printed_rate(const Subject& subject, const std::vector<double>& x, const std::vector<double>& u,
                         double delta, std::size_t j);

}  // namespace acstudy
