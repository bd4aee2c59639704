#pragma once

/// @file
/// What a study can name.

#include <string>

namespace acstudy {

/// The schemes, kernels, integrators, scenes or kinds, as `what` says, or all of them under headings if it is empty.
/// @param draw  with a line below each kernel that shows eta
std::string list_text(const std::string& what, bool draw);
/// The tables and keys that studies of a kind, or of any, may have.
/// @throws InputError  for a name that is no kind's
std::string keys_text(const std::string& kind);

}  // namespace acstudy
