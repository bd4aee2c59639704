#pragma once

/// @file
/// The HDF5 file of a study.

#include <filesystem>
#include <vector>

#include "studies/cases/study_result.hpp"
#include "studies/storing/origin.hpp"
#include "studies/storing/provenance.hpp"
#include "studies/storing/store.hpp"

namespace acstudy {

/// The file as bytes.
/// @param json_seal  the CRC of the JSON file that is written with it
std::vector<char> study_h5(const StudyResult& result, const Provenance& provenance, const std::string& json_seal);

/// Adds the content of such a file, without what is damaged. Waits some two seconds for one that is locked.
/// @param any_sources  see `load_cases`
/// @throws StoreLocked, StoreError, or another std::exception if it is no such file
void read_study_h5(const std::filesystem::path& file, bool any_sources, StoredCases& stored);

/// The study that a result file is of. @throws StoreError
StudyOrigin study_of_h5(const std::filesystem::path& file);

}  // namespace acstudy
