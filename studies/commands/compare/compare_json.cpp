#include <nlohmann/json.hpp>

#include "studies/commands/compare/compare_output.hpp"
#include "studies/commands/compare/origin.hpp"
#include "studies/storing/json_form.hpp"

namespace acstudy {

namespace {

using json = nlohmann::ordered_json;

json set_json(const ResultSet& set) {
  json out = {{"path", set.path}, {"studies", json::array()}};
  for (const ResultRecord& study : set.studies) {
    json& one = out["studies"].emplace_back();
    one = {{"study", study.study}, {"provenance", json::object()}};
    for (const auto& [name, value] : study.provenance) one["provenance"][name] = value;
  }
  return out;
}

json origins_json(const Comparison& comparison) {
  json out = json::object();
  for (const Origin& one : origins(comparison)) {
    if (one.differs()) out[one.name] = {{"old", one.before}, {"new", one.after}};
  }
  return out;
}

json pair_json(double before, double after) {
  return {{"old", before}, {"new", after}, {"ratio", ratio(before, after)}};
}

json tally_json(const Tally& tally) {
  return {{"all", tally.all},
          {"equal", tally.equal},
          {"lowest_ratio", tally.low},
          {"highest_ratio", tally.high > 0.0 ? json(tally.high) : json(nullptr)},
          {"without_ratio", tally.without_ratio}};
}

json numbers_json(const Numbers& numbers) {
  json out = {{"errors", tally_json(numbers.errors)}, {"other_norms", tally_json(numbers.norms)},
              {"values", tally_json(numbers.values)}, {"work", tally_json(numbers.work)},
              {"orders", tally_json(numbers.orders)}, {"others", tally_json(numbers.others)}};
  out["only_in_old"] = numbers.gone;
  out["only_in_new"] = numbers.added;
  out["pairs"] = pair_json(numbers.pairs.before, numbers.pairs.after);
  out["seconds"] = pair_json(numbers.seconds.before, numbers.seconds.after);
  return out;
}

json side_json(const FindingRecord* record) {
  if (record == nullptr) return nullptr;
  const Finding& finding = record->finding;
  const Judgement& judgement = finding.judgement;
  json out = {{"name", finding.label()},
              {"verdict", name_of(judgement.verdict)},
              {"expected", name_of(finding.expected)},
              {"also_expected", json::array()},
              {"as_expected", finding.as_expected()},
              {"order", judgement.order},
              {"low", judgement.low},
              {"high", judgement.high},
              {"pairwise", judgement.pairwise},
              {"reason", judgement.reason}};
  for (const Verdict also : finding.also_expected) out["also_expected"].push_back(name_of(also));
  if (!finding.failure.empty()) out["failure"] = finding.failure;
  if (finding.cases) {
    out["cases"] = finding.cases->run;
    out["cases_planned"] = finding.cases->planned;
  }
  return out;
}

template <class T>
json place_json(const Matched<T>& one) {
  return {{"N", one.any().N},
          {"h", one.any().h},
          {"delta", one.any().delta},
          {"in", one.both()             ? "both"
                 : one.after == nullptr ? "old"
                                        : "new"},
          {"differ", one.differ}};
}

/// A case with all its numbers, its times among them.
json case_json(const Matched<CaseRecord>& one) {
  json out = place_json(one);
  out["reference"] = one.any().reference;
  if (!one.both()) return out;
  std::vector<double> before;
  CaseResult::stored(one.before->result, [&]<class T>(const Stored&, const T& value) {
    if constexpr (std::is_arithmetic_v<T>) before.push_back(static_cast<double>(value));
  });
  std::size_t i = 0;
  CaseResult::stored(one.after->result, [&]<class T>(const Stored& as, const T& value) {
    if constexpr (std::is_arithmetic_v<T>) out[as.column()] = pair_json(before[i++], static_cast<double>(value));
  });
  if (one.before->reference) {
    for (const char* const error : {"error_linf", "error_l1", "error_l2"}) out.erase(error);
  }
  return out;
}

json point_json(const Matched<Point>& one) {
  json out = place_json(one);
  out["variable"] = one.any().variable;
  if (!one.any().label.empty()) out["label"] = one.any().label;
  if (one.both()) {
    out["value"] = pair_json(one.before->value, one.after->value);
    out["lower"] = pair_json(one.before->lower, one.after->lower);
    out["upper"] = pair_json(one.before->upper, one.after->upper);
  }
  return out;
}

json finding_json(const FindingComparison& one) {
  const FindingRecord& record = one.any();
  json out = {{"name", record.finding.label()}, {"change", name_of(one.change)}};
  if (!one.why.empty()) out["why"] = one.why;
  out["statement"] = record.finding.statement;
  out["subject"] = record.finding.subject;
  out["coordinates"] = json::object();
  for (const auto& [name, value] : record.coordinates) {
    std::visit([&, &key = name](const auto& plain) { out["coordinates"][key] = plain; }, value);
  }
  out["old"] = side_json(one.before);
  out["new"] = side_json(one.after);
  out["numbers"] = numbers_json(one.numbers);
  out["cases"] = json::array();
  for (const auto& c : one.cases) out["cases"].push_back(case_json(c));
  out["points"] = json::array();
  for (const auto& point : one.points) {
    if (!point.both() || !point.differ.empty()) out["points"].push_back(point_json(point));
  }
  return out;
}

}  // namespace

std::string comparison_json(const Comparison& comparison) {
  json out = {{"format", "acstudy-compare-1"},       {"worsened", comparison.worsened()},
              {"identical", comparison.identical()}, {"old", set_json(*comparison.before)},
              {"new", set_json(*comparison.after)},  {"provenance_that_differs", origins_json(comparison)}};
  for (const Change change : {Change::worsened, Change::expected, Change::improved, Change::verdict, Change::gone,
                              Change::added, Change::none}) {
    out["verdicts"][std::string(name_of(change))] = comparison.count(change);
  }
  out["numbers"] = numbers_json(comparison.numbers);
  out["studies"] = json::array();
  for (const StudyComparison& study : comparison.studies) {
    json& one = out["studies"].emplace_back();
    one = {{"study", study.any().study}, {"in", study.both() ? "both" : study.after == nullptr ? "old" : "new"}};
    if (!study.worsened.empty()) one["worsened"] = study.worsened;
    one["numbers"] = numbers_json(study.numbers);
    one["findings"] = json::array();
    for (const FindingComparison& finding : study.findings) one["findings"].push_back(finding_json(finding));
  }
  return json_form::pretty(out) + "\n";
}

}  // namespace acstudy
