#pragma once

/// @file
/// The JSON form of a study's results: written, and read back for the gate.

#include <optional>
#include <string>
#include <vector>

#include "studies/cases/study_result.hpp"
#include "studies/storing/provenance.hpp"

namespace acstudy {

/// The results of a study without the fields; real numbers at 17 significant digits, null for what is not finite.
std::string json_text(const StudyResult& result, const Provenance& provenance);

/// What a result file says of one finding; `finding` is judged again from its points.
struct FindingRecord {
  std::string study;
  Finding finding;
  std::string verdict;  ///< that the file states
};

struct ResultRecord {
  std::string study;
  std::vector<FindingRecord> findings;
  std::size_t findings_planned = 0;
};

/// @throws InputError if the file is no result file, or has nothing to check
ResultRecord read_json(const std::string& file);

}  // namespace acstudy
