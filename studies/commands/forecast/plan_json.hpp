#pragma once

/// @file
/// The plan of studies for programs that schedule them.

#include <span>
#include <string>

#include "studies/commands/forecast/forecast.hpp"

namespace acstudy {

/// A JSON object with a record per case: study, series, N, h, delta, steps, form, seconds, bytes, and the key under
/// which its result is stored. `seconds` is null where nobody knows.
std::string plan_json(std::span<const StudyForecast> studies);

}  // namespace acstudy
