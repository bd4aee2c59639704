#pragma once

/// @file
/// Result files: one HDF5 file per study with everything, a JSON file beside it without the fields.

#include <filesystem>
#include <map>
#include <string>

#include "studies/cases/study_result.hpp"
#include "studies/storing/provenance.hpp"

namespace acstudy {

/// What a study's HDF5 file and journal hold: case results by storage key (see `keys.hpp`), and where they come
/// from.
struct StoredCases {
  std::string study_file, study_text;  ///< of the study, by absolute path; empty in files of older versions
  std::map<std::string, CaseResult> cases;
  std::string findings_key;                 ///< see `keys.hpp`
  std::map<std::size_t, Finding> findings;  ///< by the number of their measurement
  Provenance provenance;
  std::vector<std::string> damaged;  ///< what is not as it was written, and is not here for that
  bool whole = false;                ///< the result file is as it was written, and there is no journal
  std::string json_seal;             ///< of the JSON file that was written with it
};

/// The content of a study's HDF5 file and of the journals beside it (see `journal.hpp`); empty if there is none. Waits
/// two seconds for another process to unlock the file. What is damaged of it is left out and named.
/// @param any_sources  also cases that other sources have computed than this program's
/// @throws StoreLocked if it does not
/// @throws StoreError if the file is there but cannot be read as a store
StoredCases load_cases(const std::filesystem::path& file, bool any_sources = false);

/// Writes `<out>/<study>.h5` and `<out>/<study>.json`, each whole or not at all (temporary file, then rename). Cases
/// that were not completed are left out of both. Then removes the
/// journals, all of which is in them.
/// @throws StoreError
void write_results(const std::filesystem::path& out, const StudyResult& result, const Provenance& provenance);

/// Whether `write_results` would write what is there, of a study of which nothing was computed.
bool results_stand(const std::filesystem::path& out, const StoredCases& stored, const Study& study);

}  // namespace acstudy
