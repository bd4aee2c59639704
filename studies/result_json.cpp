#include "studies/result_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "studies/study_file.hpp"

namespace acstudy {

namespace {

using json = nlohmann::ordered_json;

json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json series_json(const Study& study, const SeriesResult& result) {
  const Series& series = *result.series;
  const Judgement& judgement = result.judgement;
  json out;
  out["model"] = series.scheme.model;
  out["divergence"] = series.scheme.nonlocal_divergence ? "nonlocal" : "local";
  out["kernel"] = series.scheme.kernel.name;
  if (series.scheme.kernel.name == "power") out["alpha"] = series.scheme.kernel.alpha;
  if (series.scheme.model == 2) out["mu"] = series.cases.front().mu;
  out["path"] = series.path;
  out["delta"] = series.delta_text;
  out["source"] = series.nonlocal_source ? "nonlocal" : "local";
  out["integrator"] = study.integrator->name;
  out["step"] = study.step_text;
  out["motion"] = study.scene->standing() ? "standing" : "moving";
  out["theory"] = {
      {"variable", series.theory.variable}, {"order", series.theory.order}, {"statement", series.theory.statement}};
  json pairwise = json::array();
  for (const double order : judgement.pairwise) pairwise.push_back(number(order));
  for (const auto& [name, value] : named_estimates(judgement)) out["observed"][name] = number(value);
  out["observed"]["extrapolated"] = number(judgement.extrapolated);
  out["observed"]["pairwise"] = pairwise;
  out["verdict"] = name_of(judgement.verdict);
  out["expected"] = name_of(series.expected);
  out["as_expected"] = result.as_expected();
  out["reason"] = judgement.reason;
  out["cases_planned"] = series.cases.size();
  out["cases"] = json::array();
  for (const std::size_t i : result.completed()) {
    const Case& c = series.cases[i];
    const CaseResult& r = result.results[i];
    json one = {{"N", c.N},
                {"h", c.h},
                {"delta", c.delta},
                {"dt", c.dt},
                {"steps", c.steps},
                {"error_linf", number(r.error_linf)},
                {"error_l1", number(r.error_l1)},
                {"error_l2", number(r.error_l2)},
                {"seconds", r.seconds},
                {"seconds_low", r.seconds_low},
                {"seconds_high", r.seconds_high},
                {"repeats", r.repeats},
                {"source_seconds", r.source_seconds},
                {"work",
                 {{"pairs", r.work.pairs},
                  {"weight_builds", r.work.weight_builds},
                  {"quadrature_points", r.quadrature_points},
                  {"velocity_evaluations", r.work.velocity_evaluations},
                  {"flow_evaluations", r.flow_evaluations}}}};
    if (!r.blow_up.empty()) one["blow_up"] = r.blow_up;
    if (!r.failure.empty()) one["failure"] = r.failure;
    out["cases"].push_back(one);
  }
  return out;
}

/// A value as JSON; bytes that are no UTF-8, as a file name may have, are replaced.
std::string as_json_text(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

/// JSON text with every real number at 17 significant digits; the library writes the fewest that read back the same.
std::string pretty(const json& value, int depth = 0) {
  const std::string inner(static_cast<std::size_t>(depth) * 2 + 2, ' '),
      outer(static_cast<std::size_t>(depth) * 2, ' ');
  const bool leaves = std::none_of(value.begin(), value.end(), [](const json& item) { return item.is_structured(); });
  const std::string separator = leaves ? ", " : ",\n" + inner, open = leaves ? " " : "\n" + inner,
                    close = leaves ? " " : "\n" + outer;
  if (value.is_number_float()) return fmt::format("{:.17g}", value.get<double>());
  if (!value.is_structured() || value.empty()) return as_json_text(value);
  std::string text;
  for (const auto& [key, item] : value.items()) {
    text += text.empty() ? "" : separator;
    if (value.is_object()) text += as_json_text(key) + ": ";
    text += pretty(item, depth + 1);
  }
  return value.is_object() ? "{" + open + text + close + "}" : "[" + open + text + close + "]";
}

double real(const json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

Verdict verdict(const json& value) {
  const auto found = verdict_from(value.get<std::string>());
  if (!found) throw InputError("unknown verdict " + value.dump() + " in the result file");
  return *found;
}

SeriesRecord read_series(const std::string& study, const json& series) {
  SeriesRecord record;
  record.study = study;
  const bool standing = series.value("motion", std::string("moving")) == "standing";
  const KernelChoice kernel{series.at("kernel").get<std::string>(), series.value("alpha", 0.0)};
  record.label =
      series_label(series.at("model").get<int>(), standing, series.at("divergence").get<std::string>() == "nonlocal",
                   kernel, series.at("path").get<std::string>());
  const json& theory = series.at("theory");
  const bool by_h = theory.at("variable").get<std::string>() == "h";
  for (const json& one : series.at("cases")) {
    const double h = real(one.at("h")), delta = real(one.at("delta"));
    record.levels.push_back({by_h ? h : std::max(h, delta), real(one.at("error_linf"))});
    if (record.failure.empty()) record.failure = one.value("failure", "");
  }
  record.theory_order = real(theory.at("order"));
  record.expected = verdict(series.at("expected"));
  record.verdict = series.at("verdict").get<std::string>();
  record.cases_planned = series.value("cases_planned", record.levels.size());
  return record;
}

}  // namespace

std::string json_text(const Study& study, const std::vector<SeriesResult>& all, const Provenance& provenance) {
  json root = {{"study", study.name}, {"title", study.title}};
  root["provenance"] = json::object();
  for (const auto& [name, value] : provenance) root["provenance"][name] = value;
  root["series"] = json::array();
  for (const SeriesResult& series : all) root["series"].push_back(series_json(study, series));
  return pretty(root) + "\n";
}

std::vector<SeriesRecord> read_json(const std::string& file) {
  constexpr const char* remedy = "name a .json file that acstudy run has written";
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) throw InputError(fmt::format("{}: cannot read the result file; {}", file, remedy));
  std::vector<SeriesRecord> all;
  try {
    const json root = json::parse(text.str());
    for (const json& series : root.at("series"))
      all.push_back(read_series(root.at("study").get<std::string>(), series));
  } catch (const json::parse_error& error) {
    throw InputError(fmt::format("{}: not JSON, from byte {} on; {}", file, error.byte, remedy));
  } catch (const json::exception& error) {
    const std::string what = error.what();
    throw InputError(
        fmt::format("{}: not a result file of acstudy: {}; {}", file, what.substr(what.find("] ") + 2), remedy));
  }
  if (all.empty())
    throw InputError(fmt::format("{}: the result file has no series, so there is nothing to check", file));
  return all;
}

}  // namespace acstudy
