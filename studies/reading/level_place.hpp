#pragma once

/// @file
/// Where a study file asks for a level.

#include "studies/cases/study.hpp"
#include "studies/reading/toml_table.hpp"

namespace acstudy {

/// The place of N in the path of the series, or else the first one that a list of N or a key has it in; the beginning
/// of the file where N stands nowhere, as in a study that names others.
Place place_of_level(const Study& study, const Series& series, std::int64_t N);

}  // namespace acstudy
