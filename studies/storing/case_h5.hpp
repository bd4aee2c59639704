#pragma once

/// @file
/// How cases are written to HDF5.

#include <string>
#include <vector>

#include "studies/cases/study_result.hpp"
#include "studies/storing/h5.hpp"
#include "studies/storing/result_record.hpp"
#include "studies/storing/store.hpp"

namespace acstudy {

/// A column for each of the results of these cases, and their fields.
void write_cases(hid_t group, const SeriesResult& result, const std::vector<std::size_t>& indices);
/// What `write_cases` has written, by storage key.
/// @param trusted  the file is as it was written; otherwise cases are held against their checksums
/// @param damaged  gets N of those that are not as they were written
void read_cases(hid_t group, bool trusted, StoredCases& stored, std::vector<std::int64_t>& damaged);
/// The same without the fields, as records.
std::vector<CaseRecord> read_case_records(hid_t group);

}  // namespace acstudy
