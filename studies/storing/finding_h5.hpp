#pragma once

/// @file
/// How findings are written to HDF5, for result files and for the journal.

#include <string>

#include "studies/cases/finding.hpp"
#include "studies/storing/h5.hpp"

namespace acstudy {

/// What is known of a finding but its points, as attributes.
void write_verdict(hid_t group, const Finding& finding);
void write_finding(hid_t parent, const std::string& group_name, const Finding& finding);
/// @throws StoreError, or another std::exception if a name in it is not known
Finding read_finding(hid_t group);

}  // namespace acstudy
