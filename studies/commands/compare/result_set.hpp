#pragma once

/// @file
/// Result files that are compared as one: a file, or those of a folder.

#include <string>
#include <vector>

#include "studies/storing/result_record.hpp"

namespace acstudy {

struct ResultSet {
  std::string path;  ///< as it was named
  std::vector<ResultRecord> studies;
};

/// Reads a result file, JSON or HDF5, or all of a folder: of each study the JSON file, or else the HDF5 file. Benches
/// are left out.
/// @throws InputError if there is nothing of that name, if it is no result file, or if a study is in it twice
/// @throws StoreError if a file cannot be read
ResultSet read_results(const std::string& path);

}  // namespace acstudy
