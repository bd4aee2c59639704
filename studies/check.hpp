#pragma once

/// @file
/// The gate: judges result files again and compares with what their studies expect.

#include <cstddef>
#include <string>
#include <vector>

#include "reports/orders.hpp"

namespace acstudy {

/// A series of a result file, judged from the errors in the file; what the file says of itself is only compared.
struct CheckedSeries {
  std::string study, label;
  Judgement judgement;
  Verdict expected;
  std::string stored_verdict;
  std::size_t cases = 0, cases_planned = 0;

  bool passes() const {
    return meets(judgement.verdict, expected) && stored_verdict == name_of(judgement.verdict) && cases == cases_planned;
  }
  /// Why it does not pass, or the reason of the verdict.
  std::string remark() const;
};

/// @throws InputError if the file is no result file
std::vector<CheckedSeries> check_file(const std::string& file);

}  // namespace acstudy
