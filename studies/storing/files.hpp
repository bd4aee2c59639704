#pragma once

/// @file
/// Files that are written whole or not at all, and their paths.

#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace acstudy {

/// @param error  errno. @throws StoreError
[[noreturn]] void cannot_be_written(const std::filesystem::path& file, int error);

/// Writes all bytes. Returns errno, 0 if it went well.
int write_all(int descriptor, std::span<const char> bytes);

/// Writes a temporary file beside `file`, of a name that no other process has, then puts it in place in one step.
/// @throws StoreError
void replace_atomically(const std::filesystem::path& file, std::span<const char> content);

/// Removes the temporary files that processes have left which were killed while they wrote one of these.
/// @pre nobody else writes them
void remove_partial(const std::filesystem::path& folder, const std::set<std::string>& files);

/// The content of a file. @throws StoreError
std::vector<char> bytes_of(const std::filesystem::path& file);

/// Absolute and without symbolic links, as far as there is such a file.
std::string absolute_path(const std::string& file);

}  // namespace acstudy
