#pragma once

/// @file
/// How cases and findings are written to HDF5, for result files and for the journal.

#include <string>

#include "studies/cases/finding.hpp"
#include "studies/cases/case_result.hpp"
#include "studies/storing/h5.hpp"

namespace acstudy {

/// A case by itself: its fields as columns, all else as attributes.
void write_case(hid_t parent, const std::string& group_name, const std::string& key, const CaseResult& result);
/// @throws StoreError
CaseResult read_case(hid_t group);

void write_finding(hid_t parent, const std::string& group_name, const Finding& finding);
/// @throws StoreError, or another std::exception if a name in it is not known
Finding read_finding(hid_t group);

}  // namespace acstudy
