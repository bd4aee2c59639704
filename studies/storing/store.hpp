#pragma once

/// @file
/// Result files: one HDF5 file per study with everything, a JSON file beside it without the fields.

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "studies/cases/study_result.hpp"
#include "studies/storing/provenance.hpp"

namespace acstudy {

/// The machine failed the store: disk full, unreadable file, no permission.
class StoreError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Another process has the file open for writing, so that it can be neither read nor called broken.
class StoreLocked : public StoreError {
 public:
  using StoreError::StoreError;
};

/// The estimates of a judgement by the names that both result files give them, after "observed_" in the one. Levels
/// count from 1.
std::vector<std::pair<std::string, double>> named_estimates(const Judgement& judgement);

/// What a study's HDF5 file and journal hold: case results by storage key (see `storage_key`), and where they come
/// from.
struct StoredCases {
  std::string study_file, study_text;  ///< of the study, by absolute path; empty in files of older versions
  std::map<std::string, CaseResult> cases;
  std::string findings_key;                 ///< see `findings_key`
  std::map<std::size_t, Finding> findings;  ///< by the number of their measurement
  Provenance provenance;
};

/// Under which a result may be used again: all inputs of the case and the fingerprint of the code that computes it.
std::string storage_key(const Case& c);
/// The same for the findings of a study, whose cases are then all stored.
std::string findings_key(const Study& study);
/// True if findings of this key were measured by these sources.
bool of_these_measurements(const std::string& findings_key);

/// Absolute and without symbolic links, as far as there is such a file.
std::string absolute_path(const std::string& file);

/// The content of a study's HDF5 file and of the journal beside it (see `journal.hpp`); empty if there is none. Waits
/// two seconds for another process to unlock the file.
/// @throws StoreLocked if it does not
/// @throws StoreError if the file is there but cannot be read as a store
StoredCases load_cases(const std::filesystem::path& file);

/// Writes a temporary file beside `file`, then puts it in place in one step.
/// @throws StoreError
void replace_atomically(const std::filesystem::path& file, std::span<const char> content);

/// Writes `<out>/<study>.h5` and `<out>/<study>.json`, each whole or not at all (temporary file, then rename). Cases
/// that were not completed are left out of both. Then removes the journal, all of which is in them.
/// @throws StoreError
void write_results(const std::filesystem::path& out, const StudyResult& result, const Provenance& provenance);

}  // namespace acstudy
