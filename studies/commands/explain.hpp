#pragma once

/// @file
/// What a study will compute and what it leaves out, in words.

#include <string>

#include "studies/commands/forecast/forecast.hpp"

namespace acstudy {

/// The plan of a study, case by case, with what it will take.
/// @param budgets  findings on the parts of its errors that an earlier run has left
std::string explain(const StudyForecast& forecast, std::span<const Finding> budgets);

}  // namespace acstudy
