#pragma once

/// @file
/// The gate: judges result files again and compares with what their studies expect.

#include <string>
#include <vector>

#include "studies/result_json.hpp"

namespace acstudy {

/// A series of a result file, judged from the errors in the file; what the file says of itself is only compared.
struct CheckedSeries {
  SeriesRecord record;
  Judgement judgement;

  bool complete() const { return record.levels.size() == record.cases_planned; }
  bool passes() const {
    return complete() && record.verdict == name_of(judgement.verdict) && meets(judgement.verdict, record.expected);
  }
  /// Why it does not pass, or the reason of the verdict.
  std::string remark() const;
};

std::vector<CheckedSeries> check_series(std::vector<SeriesRecord> records);

}  // namespace acstudy
