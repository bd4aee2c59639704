#pragma once

/// @file
/// How findings are written to HDF5, for result files and for the journal.

#include <map>
#include <string>

#include "studies/cases/finding.hpp"
#include "studies/storing/h5.hpp"

namespace acstudy {

/// What is known of a finding but its points, as attributes.
void write_verdict(hid_t group, const Finding& finding);
void write_finding(hid_t parent, const std::string& group_name, const Finding& finding);
/// A finding of no series, judged again from its points.
/// @throws StoreError, or another std::exception if a name in it is not known
Finding read_finding(hid_t group);

/// What `write_verdict` has written; the judgement is the stated one, as far as verdict, order with interval and reason
/// go.
/// @throws StoreError, or another std::exception if a name in it is not known
Finding read_stated(hid_t group);
void read_points(hid_t group, Finding& finding);
/// The coordinates that `write_verdict` has written, by name; none in files of older versions.
std::map<std::string, Coordinate::Value> read_coordinates(hid_t group);

}  // namespace acstudy
