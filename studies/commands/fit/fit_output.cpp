#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "studies/commands/fit/fit.hpp"

namespace acstudy {

namespace {

using json = nlohmann::ordered_json;

std::string interval(const Estimate& estimate) {
  if (std::isnan(estimate.order)) return "-";
  return fmt::format("{:.3f} [{:.3f}, {:.3f}]", estimate.order, estimate.low, estimate.high);
}

std::string block_of(const Fit& fit, const FitRequest& request) {
  const Judgement& j = fit.judgement;
  const std::string v = request.count.empty() ? request.variable : "h";
  std::string text = fmt::format("{:>5}  {:>11}  {:>11}  {:>8}\n", "level", v, fit.error, "order");
  for (std::size_t i = 0; i < fit.levels.size(); ++i) {
    text += fmt::format("{:>5}  {:>11.4g}  {:>11.4g}  {:>8}\n", i + 1, fit.levels[i].variable, fit.levels[i].error,
                        i == 0 ? "-" : fmt::format("{:.3f}", j.pairwise[i - 1]));
  }
  text += "\norder and 95 % interval\n";
  const auto row = [&text](const std::string& model, const std::string& order, const std::string& rest) {
    text += fmt::format("  {:<28}  {:<24}  {}", model, order, rest);
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  };
  const auto known = [](double value, const std::string& words) { return std::isnan(value) ? "" : words; };
  row(fmt::format("error = C {}^p", v), interval(j.fitted),
      known(j.leave_one_out.change,
            fmt::format("{:+.3f} without level {}", j.leave_one_out.change, j.leave_one_out.level + 1)));
  row(fmt::format("error = C {0}^p (1 + D {0}^q)", v), interval(j.corrected),
      known(j.corrected.D, fmt::format("D = {:.3g}, q = {:.3g}", j.corrected.D, j.corrected.q)));
  row(fmt::format("error = C {}^p + F", v), interval(j.floored),
      known(j.floored.F, fmt::format("F = {:.3g}", j.floored.F)));
  row("reported", interval(j), fmt::format("levels {} to {}", j.window.first + 1, j.window.last + 1));
  return text + fmt::format("\n{}{}: {}\n", name_of(j.verdict),
                            request.order ? fmt::format(" (order {:g})", *request.order) : "", j.reason);
}

json object_of(const Fit& fit, const FitRequest& request) {
  const Judgement& j = fit.judgement;
  json out = {{"verdict", name_of(j.verdict)},
              {"reason", j.reason},
              {"theory_order", nullptr},
              {"order", j.order},
              {"low", j.low},
              {"high", j.high},
              {"pairwise", j.pairwise}};
  if (request.order) out["theory_order"] = *request.order;
  out["window"] = {{"first", j.window.first + 1}, {"last", j.window.last + 1}};
  out["fitted"] = {{"order", j.fitted.order}, {"low", j.fitted.low}, {"high", j.fitted.high}, {"C", j.fitted.C}};
  out["extrapolated"] = {{"order", j.corrected.order}, {"low", j.corrected.low}, {"high", j.corrected.high},
                         {"C", j.corrected.C},         {"D", j.corrected.D},     {"q", j.corrected.q}};
  out["floor"] = {{"order", j.floored.order},
                  {"low", j.floored.low},
                  {"high", j.floored.high},
                  {"C", j.floored.C},
                  {"F", j.floored.F}};
  out["leave_one_out"] = {{"change", j.leave_one_out.change}, {"level", nullptr}};
  if (!std::isnan(j.leave_one_out.change)) out["leave_one_out"]["level"] = j.leave_one_out.level + 1;
  out["levels"] = json::array();
  for (const Level& level : fit.levels) {
    out["levels"].push_back({{"variable", level.variable}, {"error", level.error}, {"weight", level.weight}});
  }
  return out;
}

}  // namespace

std::string as_text(const Fits& fits) {
  const FitRequest& request = fits.request;
  std::string text;
  if (!request.count.empty()) text = fmt::format("h = {}^(-1/{:g})\n", request.count, request.dimension);
  for (const Fit& fit : fits.columns) text += (text.empty() ? "" : "\n") + block_of(fit, request);
  for (const std::string& cell : fits.left_out) text += fmt::format("\nleft out, no number: {}", cell);
  return text + (fits.left_out.empty() ? "" : "\n");
}

std::string as_json(const Fits& fits) {
  json out;
  if (!fits.several) {
    out = object_of(fits.columns.front(), fits.request);
    out["column"] = fits.columns.front().error;
  } else {
    out["columns"] = json::array();
    for (const Fit& fit : fits.columns) {
      out["columns"].push_back(object_of(fit, fits.request));
      out["columns"].back()["error"] = fit.error;
    }
    out["left_out"] = fits.left_out;
  }
  if (!fits.request.count.empty()) {
    out["count"] = fits.request.count;
    out["dimension"] = fits.request.dimension;
  }
  // The library writes null for what is not finite; a name of a column may be no UTF-8.
  return out.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace acstudy
