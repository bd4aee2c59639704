#pragma once

/// @file
/// What a study can name.

#include <string>

namespace acstudy {

/// Prints the schemes, kernels, integrators or scenes, as `what` says, or all of them under headings if it is empty.
void print_list(const std::string& what);

}  // namespace acstudy
