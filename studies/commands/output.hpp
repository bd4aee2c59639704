#pragma once

/// @file
/// Where a command may write, tried before hours of work depend on it.

#include <filesystem>

namespace acstudy {

/// Makes the output folder. @throws InputError if no file can be made in it
void prepare_folder(const std::filesystem::path& out);

/// Throws an InputError unless the file can be written. It will be replaced as a whole, which no device or folder must
/// be, and no result file: in `--junit *.json` the shell names the first of them.
void require_writable(const std::filesystem::path& file);

}  // namespace acstudy
