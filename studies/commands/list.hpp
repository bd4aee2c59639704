#pragma once

/// @file
/// What a study can name.

#include <string>

namespace acstudy {

/// Prints the schemes, kernels, integrators or scenes, as `what` says, or all of them under headings if it is empty.
void print_list(const std::string& what);
/// The tables and keys that studies of a kind, or of any, may have.
/// @throws InputError  for a name that is no kind's
void print_keys(const std::string& kind);

}  // namespace acstudy
