#include "studies/commands/compare/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <type_traits>
#include <utility>

#include "studies/commands/compare/match.hpp"
#include "studies/reading/input_error.hpp"

namespace acstudy {

namespace {

struct NamedNumber {
  std::string name;
  Tally Numbers::*tally;
  double value;
};

/// All numbers of a case but its times, always the same ones in the same order.
std::vector<NamedNumber> numbers_of(const CaseRecord& one) {
  std::vector<NamedNumber> all = {{"h", &Numbers::others, one.h}, {"delta", &Numbers::others, one.delta}};
  CaseResult::stored(one.result, [&]<class T>(const Stored& as, const T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
      const std::string name = as.column(), group = as.group;
      const bool error = group.empty() && name.starts_with("error_");
      if (as.timed || (error && one.reference)) return;
      all.push_back({name,
                     name == "error_linf" ? &Numbers::errors
                     : error              ? &Numbers::norms
                     : group == "work"    ? &Numbers::work
                                          : &Numbers::others,
                     static_cast<double>(value)});
    }
  });
  return all;
}

std::vector<NamedNumber> numbers_of(const Point& one) {
  return {{"h", &Numbers::others, one.h},
          {"delta", &Numbers::others, one.delta},
          {"variable", &Numbers::others, one.variable},
          {"value", &Numbers::values, one.value},
          {"lower", &Numbers::others, one.lower},
          {"upper", &Numbers::others, one.upper}};
}

template <class T>
void compare_numbers(std::vector<Matched<T>>& all, Numbers& numbers) {
  for (Matched<T>& one : all) {
    if (!one.both()) {
      ++(one.after == nullptr ? numbers.gone : numbers.added);
      continue;
    }
    const std::vector<NamedNumber> before = numbers_of(*one.before), after = numbers_of(*one.after);
    for (std::size_t i = 0; i < before.size(); ++i) {
      (numbers.*before[i].tally).count(before[i].value, after[i].value);
      if (!same(before[i].value, after[i].value)) one.differ.push_back(before[i].name);
    }
  }
}

void compare_cases(FindingComparison& finding) {
  compare_numbers(finding.cases, finding.numbers);
  for (Matched<CaseRecord>& one : finding.cases) {
    if (!one.both()) continue;
    const CaseResult &before = one.before->result, &after = one.after->result;
    if (before.blow_up != after.blow_up) one.differ.emplace_back("blow_up");
    if (before.failure != after.failure) one.differ.emplace_back("failure");
    finding.numbers.pairs.add({static_cast<double>(before.work.pairs), static_cast<double>(after.work.pairs)});
    finding.numbers.seconds.add({before.seconds, after.seconds});
  }
}

bool same_expectation(const Check& before, const Check& after) {
  return before.expected == after.expected && before.also_expected == after.also_expected;
}

/// Whether a finding meets what another check expects.
bool meets_expectation(Finding finding, const Check& other) {
  finding.expected = other.expected;
  finding.also_expected = other.also_expected;
  return finding.as_expected();
}

/// Sets what has become of a finding that is in both sets.
void judge_change(FindingComparison& one) {
  const Finding &before = one.before->finding, &after = one.after->finding;
  const bool was = before.as_expected(), is = after.as_expected(), expected_alike = same_expectation(before, after);
  const bool failed = before.failure.empty() && !after.failure.empty();
  const bool loosened = was && is && !expected_alike && !meets_expectation(after, before);
  if ((was && !is) || failed || loosened) {
    one.change = Change::worsened;
    if (failed) {
      one.why = "it failed numerically: " + after.failure;
    } else if (after.cases && after.cases->run < after.cases->planned) {
      one.why = fmt::format("{} of {} cases; the run was interrupted", after.cases->run, after.cases->planned);
    } else if (loosened) {
      one.why = "its study expects this now; it does not meet what was expected before";
    } else {
      one.why = after.judgement.reason;
    }
  } else if (!was && is) {
    one.change = Change::improved;
  } else if (!expected_alike) {
    one.change = Change::expected;
  } else if (before.judgement.verdict != after.judgement.verdict) {
    one.change = Change::verdict;
  }
}

/// The points of a finding; those of a series are its cases.
const std::vector<Point>& points_of(const FindingRecord& record) {
  static const std::vector<Point> none;
  return record.finding.cases ? none : record.finding.points;
}

void compare_findings(FindingComparison& one) {
  if (!one.both()) {
    one.change = one.after == nullptr ? Change::gone : Change::added;
    return;
  }
  one.cases = match(one.before->cases, one.after->cases);
  one.points = match(points_of(*one.before), points_of(*one.after));
  compare_cases(one);
  compare_numbers(one.points, one.numbers);
  const Judgement &before = one.before->finding.judgement, &after = one.after->finding.judgement;
  for (const auto& [was, is] :
       {std::pair{before.order, after.order}, std::pair{before.low, after.low}, std::pair{before.high, after.high}}) {
    one.numbers.orders.count(was, is);
  }
  judge_change(one);
}

bool interrupted(const ResultRecord& study) { return study.findings.size() < study.findings_planned; }

void compare_studies(StudyComparison& study) {
  study.findings = match_findings(study);
  for (FindingComparison& one : study.findings) {
    compare_findings(one);
    study.numbers.add(one.numbers);
  }
  if (study.both() && interrupted(*study.after) && !interrupted(*study.before)) {
    study.worsened = fmt::format("{} of {} findings; the run was interrupted", study.after->findings.size(),
                                 study.after->findings_planned);
  }
}

std::string names_of(const ResultSet& set) {
  constexpr std::size_t most = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, set.studies.size()); ++i) {
    text += fmt::format("{}\"{}\"", i == 0 ? "" : ", ", set.studies[i].study);
  }
  return text + (set.studies.size() > most ? ", ..." : "");
}

}  // namespace

std::string_view name_of(Change change) {
  switch (change) {
    case Change::worsened:
      return "worsened";
    case Change::expected:
      return "expectation changed";
    case Change::improved:
      return "improved";
    case Change::verdict:
      return "verdict changed";
    case Change::gone:
      return "only in OLD";
    case Change::added:
      return "only in NEW";
    case Change::none:
      return "unchanged";
  }
  return "";
}

std::size_t Comparison::count(Change change) const {
  return std::accumulate(studies.begin(), studies.end(), std::size_t{0}, [&](std::size_t sum, const auto& study) {
    return sum + static_cast<std::size_t>(std::count_if(study.findings.begin(), study.findings.end(),
                                                        [&](const auto& one) { return one.change == change; }));
  });
}

std::size_t Comparison::matched() const {
  std::size_t all = 0;
  for (const StudyComparison& study : studies) all += study.findings.size();
  return all - count(Change::gone) - count(Change::added);
}

bool Comparison::worsened() const {
  return count(Change::worsened) > 0 ||
         std::any_of(studies.begin(), studies.end(), [](const auto& study) { return !study.worsened.empty(); });
}

bool Comparison::identical() const {
  const bool in_both = std::all_of(studies.begin(), studies.end(), [](const auto& study) { return study.both(); });
  return in_both && !worsened() && !numbers.differ() && count(Change::none) == matched() &&
         count(Change::gone) + count(Change::added) == 0;
}

Comparison compare(const ResultSet& before, const ResultSet& after) {
  Comparison all{&before, &after};
  for (const ResultRecord& record : before.studies) all.studies.push_back({{.before = &record}});
  for (const ResultRecord& record : after.studies) {
    const auto partner = std::find_if(all.studies.begin(), all.studies.end(),
                                      [&](const auto& study) { return study.any().study == record.study; });
    if (partner == all.studies.end()) {
      all.studies.push_back({{.after = &record}});
    } else {
      partner->after = &record;
    }
  }
  for (StudyComparison& study : all.studies) {
    require_distinct(before, study.before);
    require_distinct(after, study.after);
    compare_studies(study);
    all.numbers.add(study.numbers);
  }
  if (all.matched() == 0) {
    throw InputError(
        fmt::format("{} and {} have no verdict in common, so there is nothing to compare: one is of {}, the "
                    "other of {}; name results of the same studies",
                    before.path, after.path, names_of(before), names_of(after)));
  }
  return all;
}

}  // namespace acstudy
