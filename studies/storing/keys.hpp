#pragma once

/// @file
/// Under which a stored result may be used again.

#include <string>

#include "studies/cases/study.hpp"

namespace acstudy {

/// All inputs of the case and the fingerprint of the code that computes it.
std::string storage_key(const Case& c);
/// The same for the findings of a study, whose cases are then all stored.
std::string findings_key(const Study& study);
/// True if findings of this key were measured by these sources.
bool of_these_measurements(const std::string& findings_key);

}  // namespace acstudy
