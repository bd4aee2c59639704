#include "studies/storing/result_json.hpp"

#include <nlohmann/json.hpp>

#include "studies/storing/estimates.hpp"
#include "studies/storing/json_form.hpp"
#include "studies/storing/seal.hpp"

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
  out["cases_planned"] = result.results.size();
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
  return sealed(pretty(root)) + "\n";
}

}  // namespace acstudy
