#pragma once

/// @file
/// The HDF5 file of a study.

#include <filesystem>
#include <vector>

#include "studies/cases/study_result.hpp"
#include "studies/storing/provenance.hpp"
#include "studies/storing/store.hpp"

namespace acstudy {

/// The file as bytes.
std::vector<char> study_h5(const StudyResult& result, const Provenance& provenance);

/// Adds the content of such a file. Waits some two seconds for one that is locked.
/// @throws StoreLocked, StoreError, or another std::exception if it is no such file
void read_study_h5(const std::filesystem::path& file, StoredCases& stored);

}  // namespace acstudy
