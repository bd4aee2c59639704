#pragma once

/// @file
/// Scripts by which a shell completes command lines, from the commands as data.

#include <string>
#include <vector>

#include "studies/commands/command.hpp"

namespace acstudy {

/// For bash: to be sourced.
std::string bash_completion(const std::vector<Command>& commands);
/// For zsh: to be sourced, or a file `_acstudy` on its fpath.
std::string zsh_completion(const std::vector<Command>& commands);

}  // namespace acstudy
