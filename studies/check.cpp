#include "studies/check.hpp"

#include <fmt/format.h>

namespace acstudy {

std::string CheckedSeries::remark() const {
  if (!complete()) {
    return fmt::format("{} of {} cases; the run was interrupted", record.levels.size(), record.cases_planned);
  }
  if (record.verdict != name_of(judgement.verdict)) {
    return fmt::format("the file says {}, but its errors say otherwise: {}", record.verdict, judgement.reason);
  }
  return judgement.reason;
}

std::vector<CheckedSeries> check_series(std::vector<SeriesRecord> records) {
  std::vector<CheckedSeries> all;
  for (SeriesRecord& record : records) {
    Judgement judgement = judge(record.levels, record.theory_order);
    if (!record.failure.empty()) {
      judgement.verdict = Verdict::inconclusive;
      judgement.reason = not_computed(record.failure);
    }
    all.push_back({std::move(record), judgement});
  }
  return all;
}

}  // namespace acstudy
