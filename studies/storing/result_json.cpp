#include "studies/storing/result_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "studies/cases/series_verdict.hpp"
#include "studies/reading/input_error.hpp"
#include "studies/storing/estimates.hpp"
#include "studies/storing/json_form.hpp"

namespace acstudy {

namespace {

using json = nlohmann::ordered_json;
using json_form::pretty;

json observed_json(const Judgement& judgement) {
  json out;
  for (const auto& [name, value] : named_estimates(judgement)) out[name] = value;
  out["extrapolated"] = judgement.extrapolated;
  out["pairwise"] = json::array();
  for (const double order : judgement.pairwise) out["pairwise"].push_back(order);
  return out;
}

json case_json(const Case& c, const CaseResult& r) {
  json one;
  const auto put = [&one](const Stored& as, const auto& value) { json_form::put(one, as, value); };
  c.stored(put);
  CaseResult::stored(r, put);
  return one;
}

json two_powers_json(const TwoPowers& fit) {
  const auto order = [](const FittedOrder& o) { return json{{"value", o.value}, {"low", o.low}, {"high", o.high}}; };
  return {{"A", fit.A}, {"B", fit.B}, {"p", order(fit.p)}, {"q", order(fit.q)}, {"rms", fit.rms}, {"bic", fit.bic}};
}

json surface_json(const SurfaceFit& fit) {
  json out = two_powers_json(fit);
  if (fit.sum) out["sum"] = two_powers_json(*fit.sum);
  out["h_correction"] = fit.h_correction;
  out["delta_correction"] = fit.delta_correction;
  out["sharpness"] = fit.sharpness;
  out["bic_h"] = fit.bic_h;
  out["bic_delta"] = fit.bic_delta;
  return out;
}

json finding_json(const Finding& finding) {
  const Judgement& judgement = finding.judgement;
  json out = {{"statement", finding.statement}, {"claim", finding.claim},        {"subject", finding.subject},
              {"check", finding.conditions()},  {"coordinates", json::object()}, {"quantity", finding.quantity},
              {"test", name_of(finding.test)}};
  for (const Coordinate& one : finding.coordinates) {
    std::visit([&](const auto& value) { out["coordinates"][one.name] = value; }, one.value);
  }
  if (!finding.remark.empty()) out["remark"] = finding.remark;
  if (!finding.failure.empty()) out["failure"] = finding.failure;
  out["variable"] = finding.variable;
  if (finding.test != Test::bounds) {
    out["theory_order"] = finding.theory_order;
    if (finding.known.scale) out["scale"] = *finding.known.scale;
    if (finding.known.floor) out["floor"] = *finding.known.floor;
    out["observed"] = observed_json(judgement);
  }
  if (finding.surface) out["surface"] = surface_json(*finding.surface);
  out["verdict"] = name_of(judgement.verdict);
  out["promised"] = name_of(finding.promised);
  out["expected"] = name_of(finding.expected);
  for (const Verdict verdict : finding.also_expected) out["also_expected"].push_back(name_of(verdict));
  out["as_expected"] = finding.as_expected();
  out["alarm"] = finding.alarm();
  out["reason"] = judgement.reason;
  if (finding.cases) return out;
  out["points"] = json::array();
  for (const Point& point : finding.points) {
    json one = {
        {"N", point.N}, {"h", point.h}, {"delta", point.delta}, {"variable", point.variable}, {"value", point.value}};
    if (!point.label.empty()) one["label"] = point.label;
    if (finding.test == Test::bounds) {
      one["lower"] = point.lower;
      one["upper"] = point.upper;
    }
    out["points"].push_back(one);
  }
  return out;
}

/// A finding on a series with its cases.
json series_json(const Finding& finding, const SeriesResult& result) {
  const Series& series = *result.series;
  json out;
  series.stored([&out](const Stored& as, const auto& value) { json_form::put(out, as, value); });
  out.update(finding_json(finding));
  out["cases_planned"] = series.cases.size();
  out["cases"] = json::array();
  for (const std::size_t i : result.completed_levels()) {
    out["cases"].push_back(case_json(series.cases[i], result.results[i]));
  }
  if (const CaseResult* const reference = result.reference()) {
    out["reference"] = case_json(series.cases.back(), *reference);
    for (const char* const error : {"error_linf", "error_l1", "error_l2"}) out["reference"].erase(error);
  }
  return out;
}

double real(const json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

Verdict verdict(const json& value) {
  const auto found = verdict_from(value.get<std::string>());
  if (!found) throw std::invalid_argument("unknown verdict " + value.dump());
  return *found;
}

FindingRecord read_finding(const std::string& study, const json& one) {
  FindingRecord record{study, {}, one.at("verdict").get<std::string>()};
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
  judge(finding);
  return record;
}

FindingRecord read_series(const std::string& study, const json& one, std::size_t number) {
  const bool standing = one.value("motion", std::string("moving")) == "standing";
  KernelChoice kernel{one.at("kernel").get<std::string>()};
  if (const NamedKernel* const row = find_kernel(kernel.name); row != nullptr && row->parameter) {
    kernel.parameter = one.value(std::string(row->parameter->name()), 0.0);
  }
  const ModelCard* const model = find_model(one.at("model").get<std::int64_t>());
  if (model == nullptr) throw std::invalid_argument("model = " + one.at("model").dump() + " is none");
  const json& theory = one.at("theory");
  const Series series{
      .scheme = {.model = model,
                 .nonlocal_divergence = one.at("divergence").get<std::string>() == "nonlocal",
                 .kernel = kernel},
      .path = one.at("path").get<std::string>(),
      .delta_text = one.value("delta", ""),
      .stepping = one.value("stepping", ""),
      .nonlocal_source = one.value("source", "") == "nonlocal",
      .theory = {theory.at("variable").get<std::string>(), real(theory.at("order")), theory.value("statement", "")},
      .expected = verdict(one.at("expected")),
      .cases = {}};
  FindingRecord record{
      study, {series_check(series, one.value("mu", 0.0), standing, number)}, one.at("verdict").get<std::string>()};
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
  }
  if (const auto reference = one.find("reference"); reference != one.end()) {
    finding.cases->reference = {reference->at("N").get<std::int64_t>(),
                                series.variable(real(reference->at("h")), real(reference->at("delta")))};
    ++finding.cases->run;
    texts_of(*reference);
  }
  judge(finding);
  return record;
}

}  // namespace

std::string json_text(const StudyResult& result, const Provenance& provenance) {
  const Study& study = *result.study;
  json root = {{"study", study.name}, {"title", study.title}, {"kind", study.kind}};
  root["provenance"] = json::object();
  for (const auto& [name, value] : provenance) root["provenance"][name] = value;
  // Series without a finding of their own are runs that others rest on.
  if (study.measurements.empty()) root["findings"] = json::array();
  for (std::size_t i = 0; i < study.measurements.size(); ++i) {
    const std::optional<Finding>& finding = result.findings[i];
    const auto& number = study.measurements[i].check.series;
    if (finding && number) root["series"].push_back(series_json(*finding, result.series[*number]));
    if (number) continue;
    if (!root.contains("findings")) root["findings"] = json::array();
    if (finding) root["findings"].push_back(finding_json(*finding));
  }
  if (root.contains("findings")) root["findings_planned"] = study.measurements.size();
  return pretty(root) + "\n";
}

ResultRecord read_json(const std::string& file) {
  constexpr const char* remedy = "name a .json file that acstudy run has written";
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) throw InputError(fmt::format("{}: cannot read the result file; {}", file, remedy));
  ResultRecord all;
  try {
    const json root = json::parse(text.str());
    const std::string& study = all.study = root.at("study").get<std::string>();
    const json none = json::array();
    const json& findings = root.contains("findings") ? root.at("findings") : none;
    const json& series = root.contains("findings") ? none : root.at("series");
    all.findings_planned = root.contains("findings") ? root.at("findings_planned").get<std::size_t>() : series.size();
    for (const json& one : findings) all.findings.push_back(read_finding(study, one));
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
  if (all.findings.empty() && all.findings_planned == 0) {
    throw InputError(fmt::format("{}: the result file has no series, so there is nothing to check", file));
  }
  return all;
}

}  // namespace acstudy
