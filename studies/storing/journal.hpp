#pragma once

/// @file
/// What a run has finished of a study before its result files are written: one file that grows by a record at a time,
/// so that a process that is killed has lost nothing but what came after its last record.

#include <cstddef>
#include <filesystem>
#include <span>
#include <utility>
#include <vector>

#include "studies/storing/store.hpp"

namespace acstudy {

/// Cases and findings of one record.
struct Finished {
  std::vector<std::pair<const Case*, const CaseResult*>> cases;
  std::vector<std::size_t> findings;  ///< indices into `StudyResult::findings`, which are there

  bool empty() const { return cases.empty() && findings.empty(); }
};

/// `<out>/<study>.journal`
std::filesystem::path journal_path(const std::filesystem::path& out, const std::string& study);

/// A record as bytes. Calls HDF5, which is not to be called from two threads at a time.
std::vector<char> journal_record(const StudyResult& result, const Finished& finished);

/// Appends a record and waits until it is on the disk; a record that does not fit is taken back.
/// @throws StoreError
void append_to_journal(const std::filesystem::path& file, std::span<const char> record);

/// Adds the content of a journal, if there is one; of equal keys the latest record counts. Records that are not whole
/// are passed over.
/// @throws StoreError if the file is there and cannot be read
void read_journal(const std::filesystem::path& file, StoredCases& stored);

}  // namespace acstudy
