#pragma once

/// @file
/// What a manufactured solution cannot show, although all verdicts may be as expected.

#include <string>
#include <vector>

#include "studies/cases/study.hpp"

namespace acstudy {

/// Warnings about the solution of a study that runs cases, a sentence with its reason each; none where no solution is
/// known. Each is measured on samples of the fields or, for what a scheme reproduces, on its coarsest level.
///
/// They say that a term is never exercised, that a scheme reproduces the solution exactly, that the coarsest level has
/// fewer than 8 particles per wavelength, or that the source is large against the terms that it balances. After
/// Roache, and Salari and Knupp, on what a manufactured solution has to do.
std::vector<std::string> lints(const Study& study);

}  // namespace acstudy
