#pragma once

/// @file
/// Cases on the same particles, advanced together in the vector form of their schemes.

#include <atomic>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "studies/cases/case.hpp"
#include "studies/running/run_case.hpp"

namespace acstudy {

/// True if the case is run in the vector form: it is not asked for in the readable one, and has an explicit integrator,
/// a scheme without deliberate mistakes, steps that do not ask for the rows of a matrix, and for Model II on moving
/// particles velocities that are short trigonometric series.
bool runs_in_vector_form(const Case& c);

/// Cases with equal keys can be advanced together: the same particles at the same times.
std::string ensemble_key(const Case& c);
/// Cases of an ensemble with equal keys have one model, kernel and horizon; two of them that differ by their divergence
/// share their sweeps over pairs.
std::string sweep_key(const Case& c);

/// Runs cases of one key from start to error, once.
///
/// Positions, velocities and the source of the PDE are computed once for all; local and nonlocal divergence of one
/// model at one horizon share their sweep over pairs. `seconds` of a case are its share: those of all cases add up to
/// the time that passed.
/// @param threads  that share the work; the numbers do not depend on it
/// @param stop     looked at between time steps; once true, results of cases that are still running have `completed`
///                 false
/// @param most_seconds  once it can be seen that all would take much longer, some cases are put off: they are left
///                      where they are, with `completed` false, so that the others are done in about that time
/// @pre   runs_in_vector_form of every case
std::vector<CaseResult> run_ensemble(std::span<const Case* const> cases, int threads, const std::atomic<bool>& stop,
                                     double most_seconds = std::numeric_limits<double>::infinity());

}  // namespace acstudy
