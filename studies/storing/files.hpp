#pragma once

/// @file
/// Files that are written whole or not at all, and their paths.

#include <filesystem>
#include <span>
#include <string>

namespace acstudy {

/// @param error  errno. @throws StoreError
[[noreturn]] void cannot_be_written(const std::filesystem::path& file, int error);

/// Writes a temporary file beside `file`, then puts it in place in one step.
/// @throws StoreError
void replace_atomically(const std::filesystem::path& file, std::span<const char> content);

/// Absolute and without symbolic links, as far as there is such a file.
std::string absolute_path(const std::string& file);

}  // namespace acstudy
