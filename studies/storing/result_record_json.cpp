#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "studies/cases/series_verdict.hpp"
#include "studies/models/outside_program.hpp"
#include "studies/reading/input_error.hpp"
#include "studies/storing/json_form.hpp"
#include "studies/storing/result_record.hpp"
#include "studies/storing/seal.hpp"

namespace acstudy {

namespace {

using json = nlohmann::ordered_json;

double real(const json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

Verdict verdict(const json& value) {
  const auto found = verdict_from(value.get<std::string>());
  if (!found) throw std::invalid_argument("unknown verdict " + value.dump());
  return *found;
}

/// What the file states of the judgement.
Judgement stated_judgement(const json& one) {
  Judgement judgement;
  judgement.verdict = verdict_from(one.at("verdict").get<std::string>()).value_or(Verdict::inconclusive);
  judgement.reason = one.value("reason", "");
  const json observed = one.value("observed", json::object());
  const auto estimate = [&](const char* name) { return real(observed.value(name, json(nullptr))); };
  judgement.order = estimate("order");
  judgement.low = estimate("low");
  judgement.high = estimate("high");
  for (const json& order : observed.value("pairwise", json::array())) judgement.pairwise.push_back(real(order));
  return judgement;
}

/// A record with all that findings and series have in common.
FindingRecord record_of(const std::string& study, const json& one, Finding finding) {
  finding.judgement = stated_judgement(one);
  FindingRecord record{study, std::move(finding), one.at("verdict").get<std::string>()};
  const json coordinates = one.value("coordinates", json::object());
  for (const auto& [name, value] : coordinates.items()) {
    record.coordinates.emplace(
        name, value.is_string() ? Coordinate::Value(value.get<std::string>()) : Coordinate::Value(real(value)));
  }
  return record;
}

CaseRecord case_record(const json& one) {
  CaseRecord record{.N = one.value("N", std::int64_t{0}),
                    .h = real(one.value("h", json(nullptr))),
                    .delta = real(one.value("delta", json(nullptr)))};
  record.result.completed = true;
  CaseResult::stored(record.result, [&](const Stored& as, auto& value) { json_form::take(one, as, value); });
  if (!one.contains("dt_smallest")) record.result.dt_smallest = record.result.dt;  // steps are equal then
  return record;
}

FindingRecord finding_of(const std::string& study, const json& one) {
  FindingRecord record = record_of(study, one, {});
  Finding& finding = record.finding;
  finding.statement = one.at("statement").get<std::string>();
  finding.subject = one.at("subject").get<std::string>();
  finding.failure = one.value("failure", "");
  finding.coordinates = {{"check", one.at("check").get<std::string>()}};
  const auto test = test_from(one.at("test").get<std::string>());
  if (!test) throw std::invalid_argument("unknown test " + one.at("test").dump());
  finding.test = *test;
  finding.theory_order = finding.test == Test::bounds ? 0.0 : real(one.at("theory_order"));
  const auto known = [&](const char* name) {
    return one.contains(name) ? std::optional(real(one.at(name))) : std::nullopt;
  };
  finding.known = {.scale = known("scale"), .floor = known("floor")};
  finding.promised = verdict(one.at("promised"));
  finding.expected = verdict(one.at("expected"));
  for (const json& also : one.value("also_expected", json::array())) finding.also_expected.push_back(verdict(also));
  for (const json& point : one.at("points")) {
    Point& p = finding.points.emplace_back();
    p.N = point.at("N").get<std::int64_t>();
    p.h = real(point.at("h"));
    p.delta = real(point.at("delta"));
    p.variable = real(point.at("variable"));
    p.value = real(point.at("value"));
    p.label = point.value("label", "");
    if (finding.test == Test::bounds) {
      // A bound that is not there is no number in the file.
      if (!point.at("lower").is_null()) p.lower = real(point.at("lower"));
      if (!point.at("upper").is_null()) p.upper = real(point.at("upper"));
    }
  }
  return record;
}

/// Of a scheme that another program may have added: what results say of it is its name.
const ModelCard& card_named(const std::string& name) {
  if (const ModelCard* const here = find_labeled_model(name)) return *here;
  struct Named {
    std::string name;
    ModelCard card = card_beyond_paper();
  };
  static std::map<std::string, std::unique_ptr<Named>> known;
  std::unique_ptr<Named>& one = known[name];
  if (one == nullptr) {
    one = std::make_unique<Named>(Named{name});
    one->card.name = one->name;
  }
  return one->card;
}

/// What a series was run with.
SchemeChoice read_scheme(const json& one) {
  if (one.contains("command")) {
    OutsideProgram program{};
    program.command = {one.at("command").get<std::string>()};
    program.label = one.at("label").get<std::string>();
    return {.model = &outside_model, .program = std::make_shared<OutsideProgram>(std::move(program))};
  }
  KernelChoice kernel{one.at("kernel").get<std::string>()};
  if (const NamedKernel* const row = find_kernel(kernel.name); row != nullptr && row->parameter) {
    kernel.parameter = one.value(std::string(row->parameter->name()), 0.0);
  }
  const ModelCard* const model = one.contains("label") ? &card_named(one.at("label").get<std::string>())
                                                       : find_model(one.at("model").get<std::int64_t>());
  if (model == nullptr) throw std::invalid_argument("model = " + one.at("model").dump() + " is none");
  return {
      .model = model, .nonlocal_divergence = one.at("divergence").get<std::string>() == "nonlocal", .kernel = kernel};
}

FindingRecord read_series(const std::string& study, const json& one, std::size_t number) {
  const bool standing = one.value("motion", std::string("moving")) == "standing";
  const json& theory = one.at("theory");
  const Series series{
      .scheme = read_scheme(one),
      .path = one.at("path").get<std::string>(),
      .delta_text = one.value("delta", ""),
      .stepping = one.value("stepping", ""),
      .nonlocal_source = one.value("source", "") == "nonlocal",
      .theory = {theory.at("variable").get<std::string>(), real(theory.at("order")), theory.value("statement", "")},
      .expected = verdict(one.at("expected")),
      .cases = {}};
  FindingRecord record = record_of(study, one, {series_check(series, one.value("mu", 0.0), standing, number)});
  Finding& finding = record.finding;
  finding.cases = {.planned = one.value("cases_planned", one.at("cases").size()), .run = one.at("cases").size()};
  const auto texts_of = [&](const json& c) {
    if (finding.failure.empty()) finding.failure = c.value("failure", "");
    if (finding.cases->blow_up.empty()) finding.cases->blow_up = c.value("blow_up", "");
  };
  for (const json& c : one.at("cases")) {
    const bool by_h = series.theory.variable == "h";
    const double h = real(c.at("h")), delta = real(by_h ? c.value("delta", json(nullptr)) : c.at("delta"));
    add_level(finding, {c.value("N", std::int64_t{0}), h, delta, series.variable(h, delta), real(c.at("error_linf"))},
              real(c.value("solution_linf", json(nullptr))));
    texts_of(c);
    record.cases.push_back(case_record(c));
  }
  if (const auto reference = one.find("reference"); reference != one.end()) {
    finding.cases->reference = {reference->at("N").get<std::int64_t>(),
                                series.variable(real(reference->at("h")), real(reference->at("delta")))};
    ++finding.cases->run;
    texts_of(*reference);
    record.cases.push_back(case_record(*reference));
    record.cases.back().reference = true;
  }
  return record;
}

}  // namespace

ResultRecord stated_json(const std::string& file) {
  constexpr const char* remedy = "name a .json file that acstudy run has written";
  if (std::error_code none; std::filesystem::is_directory(file, none)) {
    throw InputError(fmt::format("{}: a folder; name its result files: {}", file,
                                 (std::filesystem::path(file) / "*.json").string()));
  }
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) throw InputError(fmt::format("{}: cannot read the result file; {}", file, remedy));
  ResultRecord all;
  try {
    json root = json::parse(text.str());
    all.damaged = take_seal(root) == Seal::broken;
    const std::string& study = all.study = root.at("study").get<std::string>();
    const json provenance = root.value("provenance", json::object());
    for (const auto& [name, value] : provenance.items()) {
      all.provenance.emplace_back(name, value.get<std::string>());
    }
    const json none = json::array();
    const json& findings = root.contains("findings") ? root.at("findings") : none;
    const json& series = root.contains("findings") ? none : root.at("series");
    all.findings_planned = root.contains("findings") ? root.at("findings_planned").get<std::size_t>() : series.size();
    for (const json& one : findings) all.findings.push_back(finding_of(study, one));
    for (const json& one : series) all.findings.push_back(read_series(study, one, all.findings.size()));
    std::vector<Check*> checks;
    for (FindingRecord& record : all.findings) checks.push_back(&record.finding);
    tell_apart(checks);
  } catch (const json::parse_error& error) {
    throw InputError(fmt::format("{}: not JSON, from byte {} on; {}", file, error.byte, remedy));
  } catch (const json::exception& error) {
    const std::string what = error.what();
    throw InputError(
        fmt::format("{}: not a result file of acstudy: {}; {}", file, what.substr(what.find("] ") + 2), remedy));
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: not a result file of acstudy: {}; {}", file, error.what(), remedy));
  }
  return all;
}

ResultRecord read_json(const std::string& file) {
  ResultRecord all = stated_json(file);
  if (all.findings.empty() && all.findings_planned == 0) {
    throw InputError(fmt::format("{}: the result file has no series, so there is nothing to check", file));
  }
  for (FindingRecord& record : all.findings) judge(record.finding);
  return all;
}

}  // namespace acstudy
