#pragma once

/// @file
/// What the journal holds, as bytes: a case, a finding, or whose they are.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "studies/cases/case_result.hpp"
#include "studies/cases/finding.hpp"
#include "studies/storing/store.hpp"

namespace acstudy {

/// Bytes of a record, in CBOR.
using RecordBytes = std::vector<std::uint8_t>;

RecordBytes study_record(const Study& study);
RecordBytes case_record(const std::string& key, const CaseResult& result);
/// Calls HDF5, which is not to be called from two threads at a time.
RecordBytes finding_record(const std::string& findings_key, std::size_t number, const Finding& finding);

/// What is damaged, by name.
RecordBytes damage_record(const std::string& what);
RecordBytes origin_record(const StoredCases& stored);

/// Adds what a record holds; of equal keys the latest counts. Findings of other sources are left out.
/// @throws std::exception if it is no record
void add_record(std::span<const std::uint8_t> record, StoredCases& stored);

}  // namespace acstudy
