#include "studies/commands/compare/match.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <variant>

#include "studies/reading/input_error.hpp"

namespace acstudy {

namespace {

/// A number but for round-off; JSON has null for all that is not finite.
std::string rounded(double value) { return std::isfinite(value) ? fmt::format("{:.12g}", value) : "null"; }

/// By what a case of a finding is known.
std::string key_of(const CaseRecord& one) {
  return fmt::format("{} {} {} {}", one.N, rounded(one.h), rounded(one.delta), one.reference);
}
std::string key_of(const Point& one) {
  return fmt::format("{} {} {} {} {}", one.N, rounded(one.h), rounded(one.delta), rounded(one.variable), one.label);
}

/// The things of two lists that have the same key; of several of one key the first with the first.
template <class T>
std::vector<Matched<T>> match_lists(const std::vector<T>& before, const std::vector<T>& after) {
  std::vector<Matched<T>> all;
  std::multimap<std::string, std::size_t> unmatched;
  for (const T& one : before) {
    unmatched.emplace(key_of(one), all.size());
    all.push_back({{.before = &one}});
  }
  for (const T& one : after) {
    const std::string key = key_of(one);
    const auto found = unmatched.lower_bound(key);  // the first that is left
    if (found == unmatched.end() || found->first != key) {
      all.push_back({{.after = &one}});
    } else {
      all[found->second].after = &one;
      unmatched.erase(found);
    }
  }
  return all;
}

/// By what a finding is known in its study whatever it is called; its name in files that do not say more.
std::string identity_of(const FindingRecord& record) {
  const Finding& finding = record.finding;
  if (record.coordinates.empty()) return finding.label();
  // The theorem that speaks of a series says nothing of what is run.
  std::string text = (finding.series ? "" : finding.statement) + "\n" + finding.subject;
  for (const auto& [name, value] : record.coordinates) {
    text += "\n" + name + "=";
    std::visit([&](const auto& one) { text += fmt::format("{}", one); }, value);
  }
  return text;
}

std::string name_of_finding(const FindingRecord& record) { return record.finding.label(); }

using Key = std::string (*)(const FindingRecord&);

/// Gives findings of the older study their partners among those of the newer one that have none yet.
void match_by(Key key, std::vector<FindingComparison>& all, std::vector<const FindingRecord*>& unmatched) {
  std::map<std::string, const FindingRecord*> found;
  for (const FindingRecord* const one : unmatched) found.emplace(key(*one), one);
  for (FindingComparison& one : all) {
    if (one.after != nullptr) continue;
    const auto partner = found.find(key(*one.before));
    if (partner == found.end()) continue;
    one.after = partner->second;
    found.erase(partner);
  }
  std::erase_if(unmatched, [&](const FindingRecord* one) {
    return std::any_of(all.begin(), all.end(), [&](const FindingComparison& other) { return other.after == one; });
  });
}

}  // namespace

void require_distinct(const ResultSet& set, const ResultRecord* study) {
  if (study == nullptr) return;
  std::set<std::string> seen;
  for (const FindingRecord& record : study->findings) {
    if (seen.insert(identity_of(record)).second) continue;
    throw InputError(fmt::format("{}: study \"{}\" has two findings that cannot be told apart, \"{}\"; run it again",
                                 set.path, study->study, record.finding.label()));
  }
}

std::vector<FindingComparison> match_findings(const Pair<ResultRecord>& study) {
  std::vector<FindingComparison> all;
  std::vector<const FindingRecord*> unmatched;
  if (study.before != nullptr) {
    for (const FindingRecord& record : study.before->findings) all.push_back({{.before = &record}});
  }
  if (study.after != nullptr) {
    for (const FindingRecord& record : study.after->findings) unmatched.push_back(&record);
  }
  match_by(identity_of, all, unmatched);
  match_by(name_of_finding, all, unmatched);
  for (const FindingRecord* const record : unmatched) all.push_back({{.after = record}});
  return all;
}

std::vector<Matched<CaseRecord>> match(const std::vector<CaseRecord>& before, const std::vector<CaseRecord>& after) {
  return match_lists(before, after);
}

std::vector<Matched<Point>> match(const std::vector<Point>& before, const std::vector<Point>& after) {
  return match_lists(before, after);
}

}  // namespace acstudy
