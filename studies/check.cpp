#include "studies/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "studies/study.hpp"

namespace acstudy {

namespace {

using nlohmann::json;

/// JSON has no NaN; null stands for it.
double real(const json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

Verdict verdict(const json& value) {
  const auto found = verdict_from(value.get<std::string>());
  if (!found) throw InputError("unknown verdict " + value.dump());
  return *found;
}

CheckedSeries check_series(const std::string& study, const json& series) {
  CheckedSeries checked;
  checked.study = study;
  const std::string divergence = series.value("motion", "moving") == "standing"
                                     ? ""
                                     : ", " + series.at("divergence").get<std::string>() + " divergence";
  checked.label = fmt::format("{}{}, {}, {}", series.at("model") == 1 ? "Model I" : "Model II", divergence,
                              series.at("kernel").get<std::string>(), series.at("path").get<std::string>());
  const json& theory = series.at("theory");
  const bool by_h = theory.at("variable") == "h";
  std::vector<Level> levels;
  for (const json& one : series.at("cases")) {
    const double h = real(one.at("h")), delta = real(one.at("delta"));
    levels.push_back({by_h ? h : std::max(h, delta), real(one.at("error_linf"))});
  }
  checked.judgement = judge(levels, real(theory.at("order")));
  checked.expected = verdict(series.at("expected"));
  checked.stored_verdict = series.at("verdict").get<std::string>();
  checked.cases = levels.size();
  checked.cases_planned = series.value("cases_planned", levels.size());
  return checked;
}

}  // namespace

std::string CheckedSeries::remark() const {
  if (cases != cases_planned) return fmt::format("{} of {} cases; the run was interrupted", cases, cases_planned);
  if (stored_verdict != name_of(judgement.verdict)) {
    return fmt::format("the file says {}, but its errors say otherwise: {}", stored_verdict, judgement.reason);
  }
  return judgement.reason;
}

std::vector<CheckedSeries> check_file(const std::string& file) {
  std::ifstream in(file);
  if (!in)
    throw InputError(
        fmt::format("{}: cannot read the result file; name a .json file that acstudy run has written", file));
  std::vector<CheckedSeries> all;
  try {
    const json root = json::parse(in);
    for (const json& series : root.at("series"))
      all.push_back(check_series(root.at("study").get<std::string>(), series));
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: not a result file of acstudy: {}", file, error.what()));
  }
  if (all.empty())
    throw InputError(fmt::format("{}: the result file has no series, so there is nothing to check", file));
  return all;
}

}  // namespace acstudy
