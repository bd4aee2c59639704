#pragma once

/// @file
/// What earlier runs have stored of the studies that are to be run.

#include <map>
#include <string>
#include <vector>

#include "studies/commands/run/runner.hpp"

namespace acstudy {

/// The cases of all files together, the findings and the origin of each.
struct EarlierResults {
  std::map<std::string, CaseResult> cases;
  std::vector<StoredCases> each;
};

/// What is damaged of them is said.
/// @throws InputError if results would be lost that belong to another study file
/// @throws StoreError
EarlierResults earlier_results(const std::vector<Study>& studies, const RunOptions& options);

}  // namespace acstudy
