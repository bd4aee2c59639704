#pragma once

/// @file
/// Lemmas 2.3, 2.5, 3.2 and 3.4: how far an operator is from its limits. No time stepping.

#include "studies/cases/measurement.hpp"
#include "studies/cases/subject.hpp"
#include "studies/reading/study_parts.hpp"

namespace acstudy {

/// What is left of the estimate at particles x: max over j of |operator - its limit|; of reach_j D_j itself for the
/// viscous term against the PDE, whose limit is zero. A and D are told apart by mu, in which the operator is affine.
double estimate_error(const Subject& subject, const LemmaEstimate& estimate, const std::vector<double>& x,
                      double delta);

/// Uniformity in delta: whatever the horizon of the resolutions, the error divided by h (by max(h, delta) against the
/// PDE) is at most a constant that is derived from the fields of the scene, not fitted; see docs/equations.md. A point
/// per N, at the horizon where the error comes closest to its bound.
Measurement consistency_whatever_delta(const Subject& subject, const LemmaEstimate& estimate,
                                       const Resolutions& resolutions);

/// Errors along a path: they vanish with at least order 1, or with path.order if that is given.
/// @pre path.nonlocal_source == estimate.nonlocal
Measurement consistency_along(const Subject& subject, const LemmaEstimate& estimate, const PathChoice& path);

/// What a scheme, with its own source, leaves of its equation along a path: it vanishes with at least the order of its
/// card.  @pre the scheme is one that runs here; a nonlocal model of it is known, or the path has the source of the PDE
Measurement truncation_along(const Subject& subject, const PathChoice& path,
                             const std::vector<Coordinate>& conditions = {});

/// Sharpness of Lemma 3.2 where delta = ratio h, ratio < 1/2: order 2 in h; on jittered particles
/// at least 1.
Measurement order_below_spacing(const Subject& subject, const LemmaEstimate& estimate,
                                const std::vector<std::int64_t>& N, double ratio);

/// Sharpness of the second term as delta goes to zero at fixed h: whether errors grow as it would have it. They do
/// not.  @pre the estimate has one
Measurement growth_below_spacing(const Subject& subject, const LemmaEstimate& estimate, std::int64_t N,
                                 const std::vector<double>& ratios);

}  // namespace acstudy
