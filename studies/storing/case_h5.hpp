#pragma once

/// @file
/// How cases are written to HDF5: by themselves in the journal, as columns in result files.

#include <string>
#include <vector>

#include "studies/cases/study_result.hpp"
#include "studies/storing/h5.hpp"
#include "studies/storing/result_record.hpp"
#include "studies/storing/store.hpp"

namespace acstudy {

/// A case by itself: its fields as columns, all else as attributes.
void write_case(hid_t parent, const std::string& group_name, const std::string& key, const CaseResult& result);
/// @throws StoreError
CaseResult read_case(hid_t group);

/// A column for each of the results of these cases, and their fields.
void write_cases(hid_t group, const SeriesResult& result, const std::vector<std::size_t>& indices);
/// What `write_cases` has written, by storage key.
void read_cases(hid_t group, StoredCases& stored);
/// The same without the fields, as records.
std::vector<CaseRecord> read_case_records(hid_t group);

}  // namespace acstudy
