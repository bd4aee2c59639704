#pragma once

/// @file
/// The gate: judges result files again and compares with what their studies expect.

#include <string>
#include <vector>

#include "studies/commands/gate.hpp"
#include "studies/storing/result_record.hpp"

namespace acstudy {

/// "1.02 [0.98, 1.06]", or "-" where no order was estimated.
std::string observed_text(const Judgement& judgement);
/// The expected verdict, with those that are as right.
std::string expected_text(const Finding& finding);

/// The row of a finding, which is read from no file.
Row row_of(const std::string& study, const Finding& finding);

/// A row per finding of a result file, judged from the numbers in it; what the file says of itself is only
/// compared. What is missing because a run was interrupted departs.
/// @throws InputError if the file is no result file
std::vector<Row> check_file(const std::string& file);

}  // namespace acstudy
