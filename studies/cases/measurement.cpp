#include "studies/cases/measurement.hpp"

#include <stdexcept>

#include "studies/cases/study_result.hpp"

namespace acstudy {

Finding Measurement::take(const Results& results) const {
  Finding finding{check};
  const auto fails = [&](const std::exception& error) {
    finding.failure = error.what();
    // Nothing measured is nothing that a check without bounds may show.
    if (finding.expected == Verdict::inconclusive) finding.promised = finding.expected = Verdict::holds;
  };
  try {
    measure(finding, results);
  } catch (const std::domain_error& error) {
    fails(error);
  } catch (const std::runtime_error& error) {
    fails(error);
  }
  judge(finding);
  return finding;
}

Finding Measurement::take() const { return take({}); }

}  // namespace acstudy
