#pragma once

/// @file
/// What a run has finished of a study before its result files are written: one file that grows by a record at a time,
/// so that a process that is killed has lost nothing but what came after its last record.

#include <cstddef>
#include <cstdint>
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
/// @param shard  "" or, of a run that does a share, `Shard::suffix()`
std::filesystem::path journal_path(const std::filesystem::path& out, const std::string& study,
                                   const std::string& shard);
/// The journals of a study in a folder: that of a run, and those of shards.
std::vector<std::filesystem::path> journals_of(const std::filesystem::path& folder, const std::string& study);
/// Of which study a file of this name is a journal; empty if of none.
std::string study_of_journal(const std::string& name);

/// Whose results follow, as bytes: how a journal begins.
std::vector<char> journal_head(const Study& study);
/// What is finished, as bytes. Calls HDF5, which is not to be called from two threads at a time.
std::vector<char> journal_records(const StudyResult& result, const Finished& finished);

/// A record as it stands in a journal.
std::vector<char> framed(std::span<const std::uint8_t> record);
/// Adds the content of records as they stand in a journal.
/// @return how many are not as they were written  @throws std::exception if one is no record
std::size_t read_records(std::span<const char> records, StoredCases& stored);

/// Appends records and waits until they are on the disk; what does not fit is taken back.
/// @throws StoreError
void append_to_journal(const std::filesystem::path& file, std::span<const char> records);

/// Adds the content of a journal; of equal keys the latest record counts. Records that are not whole are passed over.
/// @throws StoreError if it cannot be read
void read_journal(const std::filesystem::path& file, StoredCases& stored);
/// `study_file` and `study_text` of a journal, from its first records.
StoredCases journal_origin(const std::filesystem::path& file);

}  // namespace acstudy
