#include "studies/cases/study_result.hpp"

namespace acstudy {

std::vector<std::size_t> SeriesResult::completed() const {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].completed) indices.push_back(i);
  }
  return indices;
}

std::vector<std::size_t> SeriesResult::completed_levels() const {
  std::vector<std::size_t> indices = completed();
  if (reference() != nullptr) indices.pop_back();
  return indices;
}

const CaseResult* SeriesResult::reference() const {
  return series->against_reference && results.back().completed ? &results.back() : nullptr;
}

}  // namespace acstudy
