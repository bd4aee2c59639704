#pragma once

/// @file
/// A study file to begin with.

#include <string>

namespace acstudy {

/// A commented convergence study that runs as it is. @param name  as in [study]
std::string first_study(const std::string& name);

}  // namespace acstudy
