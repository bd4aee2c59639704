#pragma once

/// @file
/// What a study will compute and what it leaves out, in words.

#include <string>

#include "studies/cases/study.hpp"

namespace acstudy {

/// The plan of a study, case by case; computes nothing.
std::string explain(const Study& study);

}  // namespace acstudy
