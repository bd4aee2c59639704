#pragma once

/// @file
/// Which studies a folder has results of.

#include <filesystem>
#include <string>
#include <vector>

namespace acstudy {

/// A study as it is stored with its results.
struct StudyOrigin {
  std::string name, file, text;
  std::filesystem::path stored_in;
};

/// Those of a folder, from its journals and, for studies that have none, from result files. A study may be there
/// several times.
/// @throws StoreError
std::vector<StudyOrigin> stored_studies(const std::filesystem::path& folder);

}  // namespace acstudy
