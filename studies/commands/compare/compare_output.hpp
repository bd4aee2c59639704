#pragma once

/// @file
/// What a comparison says, for people and for programs.

#include <string>

#include "studies/commands/compare/comparison.hpp"

namespace acstudy {

/// The differences, worst first, in lines as long as the terminal is wide: some 40 lines.
/// @param all  every difference, in as many lines as it takes
std::string comparison_text(const Comparison& comparison, bool all);

/// Everything that was compared as a JSON object, of format "acstudy-compare-1". Points that are equal are counted
/// only.
std::string comparison_json(const Comparison& comparison);

}  // namespace acstudy
