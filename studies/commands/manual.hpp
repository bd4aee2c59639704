#pragma once

/// @file
/// What the commands say of themselves: help texts and the man page, both from the commands as data.

#include <cstddef>
#include <string>
#include <vector>

#include "studies/commands/command.hpp"

namespace acstudy {

/// An option as it is written: "--out DIR", "-v, --verbose", "STUDY.toml...".
std::string written(const Option& option);
/// The spellings of an option: "-v" and "--verbose"; of a positional argument its name.
std::vector<std::string> spellings(const Option& option);
bool is_flag(const Option& option);
bool is_positional(const Option& option);

/// What `acstudy --help` prints, in lines of `width` characters.
std::string help_text(const std::vector<Command>& commands, std::size_t width);
/// What `acstudy COMMAND --help` prints.
std::string help_text(const Command& command, std::size_t width);

/// The man page acstudy(1), in roff.
std::string man_page(const std::vector<Command>& commands);

}  // namespace acstudy
