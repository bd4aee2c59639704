#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "studies/commands/fit/fit_values.hpp"

namespace acstudy {

namespace {

using json = nlohmann::ordered_json;

std::string number(double value, const char* format) {
  return std::isnan(value) ? "-" : fmt::format(fmt::runtime(format), value);
}

std::string interval(double value, double low, double high, const char* format) {
  if (std::isnan(value) && std::isnan(low)) return "-";
  const std::string between =
      std::isnan(low) ? "" : fmt::format(" [{}, {}]", number(low, format), number(high, format));
  return number(value, format) + between;
}

/// A value with its interval, in the digits that the interval leaves it and one more.
std::string value_with_interval(double value, double low, double high) {
  const double width = high - low;
  if (!(width > 0.0) || value == 0.0) return interval(value, low, high, "{:.8g}");
  const double digits = std::floor(std::log10(std::abs(value))) - std::floor(std::log10(width)) + 2.0;
  // "#" keeps zeros that are digits, and a point behind whole numbers.
  const auto text = [&](double x) {
    std::string printed = fmt::format("{:#.{}g}", x, static_cast<int>(std::clamp(digits, 2.0, 15.0)));
    if (printed.back() == '.') printed.pop_back();
    return printed;
  };
  return fmt::format("{} [{}, {}]", text(value), text(low), text(high));
}

/// The name of the variable.
std::string variable_of(const FitRequest& request) { return request.count.empty() ? request.variable : "h"; }

template <class AnyJudgement>
std::string verdict_of(const AnyJudgement& j, const FitRequest& request) {
  return fmt::format("\n{}{}: {}\n", name_of(j.verdict),
                     request.order ? fmt::format(" (order {:g})", *request.order) : "", j.reason);
}

/// What is said of errors and of values alike.
template <class AnyJudgement>
json verdict_object(const AnyJudgement& j, const FitRequest& request) {
  return {{"verdict", name_of(j.verdict)},
          {"reason", j.reason},
          {"theory_order", request.order ? json(*request.order) : json(nullptr)},
          {"order", j.order},
          {"low", j.low},
          {"high", j.high},
          {"pairwise", j.pairwise}};
}

/// An order and its interval.
template <class Estimate>
std::string order(const Estimate& e) {
  return interval(e.order, e.low, e.high, "{:.3f}");
}

std::string block_of(const Fit& fit, const FitRequest& request) {
  const Judgement& j = fit.judgement;
  const std::string v = variable_of(request);
  std::string text = fmt::format("{:>5}  {:>11}  {:>11}  {:>8}\n", "level", v, fit.column, "order");
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
  row(fmt::format("error = C {}^p", v), order(j.fitted),
      known(j.leave_one_out.change,
            fmt::format("{:+.3f} without level {}", j.leave_one_out.change, j.leave_one_out.level + 1)));
  row(fmt::format("error = C {0}^p (1 + D {0}^q)", v), order(j.corrected),
      known(j.corrected.D, fmt::format("D = {:.3g}, q = {:.3g}", j.corrected.D, j.corrected.q)));
  row(fmt::format("error = C {}^p + F", v), order(j.floored),
      known(j.floored.F, fmt::format("F = {:.3g}", j.floored.F)));
  row("reported", order(j), fmt::format("levels {} to {}", j.window.first + 1, j.window.last + 1));
  return text;
}

json object_of(const Fit& fit, const FitRequest& request) {
  const Judgement& j = fit.judgement;
  json out = verdict_object(j, request);
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

std::string line(const std::string& name, const std::string& value, const std::string& rest) {
  std::string text = fmt::format("  {:<32}  {}", name, value);
  if (!rest.empty()) text = fmt::format("  {:<32}  {:<32}  {}", name, value, rest);
  return text + '\n';
}

/// The share of the finest value that its grid convergence index is, as Roache defines it; of differences the index.
double relative_gci(const ValueFit& fit) {
  const double uncertainty = fit.judgement.gci.uncertainty;
  return fit.values.empty() ? uncertainty : uncertainty / std::abs(fit.values.back().value);
}

std::string levels_of(const ValueFit& fit, const std::string& variable) {
  const ValueJudgement& j = fit.judgement;
  const bool values = !fit.values.empty();
  std::string text = fmt::format("{:>5}  {:>11}  {:>13}  {:>11}  {:>8}\n", "level", variable, values ? fit.column : "",
                                 values ? "difference" : fit.column, "order");
  const std::size_t levels = values ? fit.values.size() : j.differences.size() + 1;
  for (std::size_t i = 0; i < levels; ++i) {
    const double at = values                     ? fit.values[i].variable
                      : i < j.differences.size() ? j.differences[i].variable
                                                 : j.differences.back().finer;
    text += fmt::format("{:>5}  {:>11.4g}  {:>13}  {:>11}  {:>8}\n", i + 1, at,
                        values ? fmt::format("{:.8g}", fit.values[i].value) : "",
                        i > 0 ? fmt::format("{:+.4g}", j.differences[i - 1].difference) : "-",
                        i > 1 ? number(j.pairwise[i - 2], "{:.3f}") : "-");
  }
  return text;
}

std::string block_of(const ValueFit& fit, const FitRequest& request) {
  const ValueJudgement& j = fit.judgement;
  // The order stands in the verdict alone: here it would be that of another model, with another interval.
  std::string text;
  const std::string levels = fmt::format("levels {} to {}", j.first + 1, j.differences.size() + 1);
  if (!fit.values.empty()) {
    text += line("extrapolated value L", value_with_interval(j.extrapolated, j.extrapolated_low, j.extrapolated_high),
                 levels);
  }
  const Gci& gci = j.gci;
  if (!std::isnan(gci.uncertainty)) {
    text += line("grid convergence index",
                 fit.values.empty() ? fmt::format("{:.3g}", gci.uncertainty)
                                    : fmt::format("{:.3g} ({:.3g} %)", gci.uncertainty, 100.0 * relative_gci(fit)),
                 fmt::format("safety factor {:g}, order {:.3f}: {}", gci.safety_factor, gci.order, gci.why));
  }
  const LeastSquaresUncertainty& u = j.least_squares;
  if (!std::isnan(u.uncertainty)) {
    text += line("least squares (Eca, Hoekstra)", fmt::format("{:.3g}", u.uncertainty),
                 fmt::format("safety factor {:g}, fit of {}{}, p = {:.3f}", u.safety_factor, u.expansion,
                             u.weighted ? ", weighted" : "", u.order));
  }
  return levels_of(fit, variable_of(request)) +
         (text.empty() ? "" : "\nestimates, the value with its 95 % interval\n" + text);
}

json object_of(const ValueLaw& law) {
  return {{"order", law.order},
          {"low", law.low},
          {"high", law.high},
          {"value", law.value},
          {"value_low", law.value_low},
          {"value_high", law.value_high},
          {"C", law.C},
          {"D", law.D},
          {"q", law.q}};
}

json object_of(const ValueFit& fit, const FitRequest& request) {
  const ValueJudgement& j = fit.judgement;
  json out = verdict_object(j, request);
  out["extrapolated"] = j.extrapolated;
  out["extrapolated_low"] = j.extrapolated_low;
  out["extrapolated_high"] = j.extrapolated_high;
  out["gci"] = relative_gci(fit);
  out["gci_absolute"] = j.gci.uncertainty;
  out["gci_order"] = j.gci.order;
  out["safety_factor"] = j.gci.safety_factor;
  out["safety_factor_reason"] = j.gci.why;
  out["uncertainty"] = j.least_squares.uncertainty;
  out["window"] = {{"first", j.first + 1}, {"last", j.differences.size() + 1}};
  if (!fit.values.empty()) {
    out["fitted"] = object_of(j.fitted);
    out["corrected"] = object_of(j.corrected);
    const LeastSquaresUncertainty& u = j.least_squares;
    out["least_squares"] = {{"uncertainty", u.uncertainty},     {"error", u.error},         {"order", u.order},
                            {"extrapolated", u.value},          {"deviation", u.deviation}, {"data_range", u.range},
                            {"safety_factor", u.safety_factor}, {"expansion", u.expansion}, {"weighted", u.weighted}};
    out["levels"] = json::array();
    for (const Value& value : fit.values) {
      out["levels"].push_back({{"variable", value.variable}, {"value", value.value}});
    }
  }
  out["differences"] = json::array();
  for (const Difference& d : j.differences) {
    out["differences"].push_back({{"variable", d.variable}, {"finer", d.finer}, {"difference", d.difference}});
  }
  return out;
}

template <class Judged>
std::string text_of(const JudgedColumns<Judged>& fits) {
  const FitRequest& request = fits.request;
  std::string text;
  if (!request.count.empty()) text = fmt::format("h = {}^(-1/{:g})\n", request.count, request.dimension);
  for (const Judged& one : fits.columns) {
    text += (text.empty() ? "" : "\n") + block_of(one, request) + verdict_of(one.judgement, request);
  }
  for (const std::string& cell : fits.left_out) text += fmt::format("\nleft out, no number: {}", cell);
  return text + (fits.left_out.empty() ? "" : "\n");
}

/// @param name  under which one of several columns has its name
template <class Judged>
std::string json_of(const JudgedColumns<Judged>& fits, const char* name) {
  json out;
  if (!fits.several) {
    out = object_of(fits.columns.front(), fits.request);
    out["column"] = fits.columns.front().column;
  } else {
    out["columns"] = json::array();
    for (const Judged& one : fits.columns) {
      out["columns"].push_back(object_of(one, fits.request));
      out["columns"].back()[name] = one.column;
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

}  // namespace

std::string as_text(const Fits& fits) { return text_of(fits); }
std::string as_text(const ValueFits& fits) { return text_of(fits); }
std::string as_json(const Fits& fits) { return json_of(fits, "error"); }
std::string as_json(const ValueFits& fits) { return json_of(fits, "column"); }

}  // namespace acstudy
