#pragma once

/// @file
/// What a manufactured solution cannot show, although all verdicts may be as expected.

#include <span>
#include <string>
#include <vector>

#include "studies/cases/finding.hpp"
#include "studies/cases/study.hpp"

namespace acstudy {

/// Warnings about the solution of a study that runs cases, a sentence with its reason each; none where no solution is
/// known. Each is measured on samples of the fields or, for what a scheme reproduces, on its coarsest level.
///
/// They say that a term is never exercised, that a scheme reproduces the solution exactly, that the coarsest level has
/// fewer than 8 particles per wavelength, or that the source is large against the terms that it balances. After
/// Roache, and Salari and Knupp, on what a manufactured solution has to do.
std::vector<std::string> lints(const Study& study);

/// Warnings about series of the study whose time steps make most of an error: the order that is observed is then not
/// that of the scheme in space, and a mistake there can hide.
/// @param budgets  findings of studies of kind "pollution", of this study and of others
std::vector<std::string> hidden_by_time(const Study& study, std::span<const Finding> budgets);

}  // namespace acstudy
