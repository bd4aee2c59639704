#pragma once

/// @file
/// What weights satisfy exactly, or within a bound: Remarks 2.1 and 2.2, (2.3), (3.4), (3.5) and Lemma 3.1.

#include "studies/cases/measurement.hpp"
#include "studies/cases/subject.hpp"

namespace acstudy {

/// Remark 2.1 and its counterpart for Model II: with delta = ratio h_min, ratio < 1, every row of the operator is that
/// of the upwind difference, or of the central difference with the viscosity of the nearest neighbors. With ratio > 1
/// it is not: the negative control.
Measurement nearest_neighbor_rows(const Subject& subject, const std::vector<std::int64_t>& N, double ratio);

/// Model I, Remark 2.2: W_k >= 0.  Model II: sign(k) W_k >= 0.
Measurement weights_are_not_negative(const Subject& subject, const Sweep& sweep);
/// Model I, Remark 2.2: sum d_k W_k = 1.  Model II, (3.4): sum (x_i - x_j) W_k / N_j = 1.
Measurement first_moment_is_one(const Subject& subject, const Sweep& sweep);
/// Model II, (3.4): sum W_k = 0.
Measurement weights_cancel(const Subject& subject, const Sweep& sweep);
/// Model II, (3.5): the second moment is at most max(h, delta); `one_sided` takes |W_k| in place of W_k, which is what
/// the proof of Lemma 3.4 needs.
Measurement second_moment_is_bounded(const Subject& subject, const Sweep& sweep, bool one_sided);
/// Model II, Lemma 3.1: |N_j - 1| <= C h/delta with C = int_0^1 eta.
Measurement renormalization_is_near_one(const Subject& subject, const Sweep& sweep);
/// Model II, Lemma 3.1: the largest |N_j - 1| at a fixed horizon is at least of order 1 in h/delta.
Measurement order_of_renormalization(const Subject& subject, const std::vector<std::int64_t>& N, double delta);
/// Model II, Lemma 3.1 as printed: N_j >= 1. Searches for the smallest N_j: every pattern of four gaps with the ratios
/// 1, 4, 20, and horizons just below a particle, where the outermost cell is longest. It is below one.
/// @pre N is a multiple of 4, at least 12; the subject's own arrangement does not matter
Measurement renormalization_is_at_least_one(const Subject& subject, std::int64_t N);

/// (2.3) and its twin for Model II by adaptive quadrature, by two libraries: the first moment is one, and the closed
/// forms of the cell moments at 1/10, 1/5, ... 1 are the integrals.
Measurement kernel_moments(const KernelChoice& kernel);

}  // namespace acstudy
