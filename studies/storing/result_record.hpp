#pragma once

/// @file
/// What result files say, read back: for the gate, and for the comparison of two of them.

#include <map>
#include <string>
#include <vector>

#include "studies/cases/case_result.hpp"
#include "studies/cases/finding.hpp"
#include "studies/storing/provenance.hpp"

namespace acstudy {

/// A case of a series without its fields.
struct CaseRecord {
  std::int64_t N = 0;
  double h = std::numeric_limits<double>::quiet_NaN(), delta = std::numeric_limits<double>::quiet_NaN();
  bool reference = false;  ///< the run that errors are against: it has none
  CaseResult result = {};
};

/// What a result file says of one finding.
struct FindingRecord {
  std::string study;
  Finding finding;
  std::string verdict;  ///< that the file states, be it one or not
  /// All of the check, by name; empty in files of older versions.
  std::map<std::string, Coordinate::Value> coordinates = {};
  std::vector<CaseRecord> cases = {};  ///< of a finding on a series
};

struct ResultRecord {
  std::string study;
  Provenance provenance;
  std::vector<FindingRecord> findings;
  std::size_t findings_planned = 0;
  bool damaged = false;  ///< the file is not as it was written
};

/// A JSON result file as it stands: the judgement of a finding is the stated one, as far as its verdict, order with
/// interval, pairwise orders and reason go.
/// @throws InputError if the file is no result file
ResultRecord stated_json(const std::string& file);

/// The same of an HDF5 result file, of which it reads what the JSON form holds.
/// @throws StoreError if the file cannot be read, or is no result file
ResultRecord stated_h5(const std::string& file);

/// A JSON result file, each finding judged again from its points.
/// @throws InputError if the file is no result file, or has nothing to check
ResultRecord read_json(const std::string& file);

}  // namespace acstudy
