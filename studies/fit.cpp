#include "studies/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "studies/input_error.hpp"
#include "studies/number_table.hpp"

namespace acstudy {

namespace {

std::vector<Level> read_levels(const FitRequest& request) {
  const NumberTable table(request.file);
  const std::size_t variable = table.column(request.variable), error = table.column(request.error);
  const std::size_t weight = request.weight.empty() ? table.columns() : table.column(request.weight);
  std::vector<Level> levels;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    Level level{table.positive(row, variable), table.number(row, error).value};
    if (weight < table.columns()) level.weight = table.positive(row, weight);
    levels.push_back(level);
  }
  std::stable_sort(levels.begin(), levels.end(), [](auto& a, auto& b) { return a.variable > b.variable; });
  return levels;
}

std::string interval(const Estimate& estimate) {
  if (std::isnan(estimate.order)) return "-";
  return fmt::format("{:.3f} [{:.3f}, {:.3f}]", estimate.order, estimate.low, estimate.high);
}

}  // namespace

bool Fit::passes() const {
  if (!request.order) return false;
  return meets(judgement.verdict, *request.order == 0.0 ? Verdict::stagnates : Verdict::confirmed);
}

Fit fit_table(const FitRequest& request) {
  if (request.order && !(std::isfinite(*request.order) && *request.order >= 0.0)) {
    throw InputError(fmt::format(
        "--order = {}; an order must be finite and not negative; write 0 where the error must settle", *request.order));
  }
  Fit fit{request, read_levels(request), {}};
  fit.judgement = judge(fit.levels, request.order.value_or(not_estimated));
  return fit;
}

std::string as_text(const Fit& fit) {
  const Judgement& j = fit.judgement;
  const std::string& v = fit.request.variable;
  std::string text = fmt::format("{:>5}  {:>11}  {:>11}  {:>8}\n", "level", v, fit.request.error, "order");
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
                            fit.request.order ? fmt::format(" (order {:g})", *fit.request.order) : "", j.reason);
}

std::string as_json(const Fit& fit) {
  using json = nlohmann::ordered_json;
  const Judgement& j = fit.judgement;
  json out = {{"verdict", name_of(j.verdict)},
              {"reason", j.reason},
              {"theory_order", nullptr},
              {"order", j.order},
              {"low", j.low},
              {"high", j.high},
              {"pairwise", j.pairwise}};
  if (fit.request.order) out["theory_order"] = *fit.request.order;
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
  return out.dump(2) + "\n";  // the library writes null for what is not finite
}

}  // namespace acstudy
