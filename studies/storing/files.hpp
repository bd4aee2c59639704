#pragma once

/// @file
/// Files that are written whole or not at all, and their paths.

#include <filesystem>
#include <span>
#include <string>

namespace acstudy {

/// Writes a temporary file beside `file`, then puts it in place in one step.
/// @throws StoreError
void replace_atomically(const std::filesystem::path& file, std::span<const char> content);

/// Absolute and without symbolic links, as far as there is such a file.
std::string absolute_path(const std::string& file);

}  // namespace acstudy
