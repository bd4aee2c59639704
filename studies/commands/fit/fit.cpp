#include "studies/commands/fit/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/commands/fit/fit_columns.hpp"

namespace acstudy {

namespace {

enum class Growth { none, possible, whole };

/// Whether the errors fall as the variable grows, and whether it is then whole, as a number of cells is.
Growth growth(const Fit& fit) {
  const std::vector<double>& orders = fit.judgement.pairwise;
  constexpr double clearly = -0.2;  // a first order in three dimensions is -1/3 in the number of cells
  const auto negative = std::count_if(orders.begin(), orders.end(), [](double order) { return order < clearly; });
  const bool finite = std::none_of(orders.begin(), orders.end(), [](double order) { return std::isnan(order); });
  if (!finite || 2 * negative <= static_cast<std::ptrdiff_t>(orders.size())) return Growth::none;
  if (!(fit.levels.front().error < fit.levels.back().error) || fit.levels.back().variable < 2.0) return Growth::none;
  const bool whole = std::all_of(fit.levels.begin(), fit.levels.end(),
                                 [](const Level& level) { return level.variable == std::floor(level.variable); });
  return whole ? Growth::whole : Growth::possible;
}

/// An order as a user would write it: the nearest half, if there is one near.
std::string order_to_ask_for(double order) {
  const double half = std::round(2.0 * order) / 2.0;
  return std::abs(order - half) <= extrapolation_tolerance ? fmt::format("{:g}", half) : fmt::format("{:.2f}", order);
}

/// What only the command line knows: its remedies, and which levels it chose.
void add_to_reason(Fit& fit, const FitRequest& request, std::size_t first, std::size_t levels) {
  Judgement& j = fit.judgement;
  if (const Growth grows = growth(fit); request.count.empty() && grows != Growth::none) {
    const std::string hint = fmt::format(
        "the variable {0} grows as the errors fall; if it counts cells, write --count {0} --dimension D, so that h = "
        "{0}^(-1/D)",
        request.variable);
    j.reason = grows == Growth::whole ? hint : j.reason + "; " + hint;
    if (grows == Growth::whole) j.verdict = Verdict::inconclusive;
  } else if (j.verdict == Verdict::above && request.order && !std::isnan(j.order)) {
    j.reason += fmt::format("; theorems are upper bounds: write --order {} to ask for the order that is seen",
                            order_to_ask_for(j.order));
  }
  if (request.levels.empty()) return;
  j.reason += fmt::format("; levels {} to {} of {}, as asked{}", first + 1, first + fit.levels.size(), levels,
                          first > 0 ? ", here counted from 1" : "");
}

/// Levels as the rows stand, with variable and weight but no error yet.
std::vector<Level> read_levels(const NumberTable& table, const FitRequest& request) {
  std::vector<Level> levels;
  for (const double variable : variables_of(table, request)) levels.push_back({variable, not_estimated});
  if (request.weight.empty()) return levels;
  const std::size_t weight = table.column(request.weight, "--weight");
  for (std::size_t row = 0; row < levels.size(); ++row) levels[row].weight = table.positive(row, weight);
  return levels;
}

/// Judges the errors in a column at `levels`, which stand as the rows do.
Fit fit_column(const NumberTable& table, std::size_t column, std::vector<Level> levels, const FitRequest& request) {
  const std::vector<Printed> errors = table.numbers(column);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const auto [error, half_unit] = errors[i];
    levels[i].error = error;
    if (half_unit > 0.0) levels[i].noise = half_unit / std::abs(error) / std::sqrt(3.0);
  }
  std::stable_sort(levels.begin(), levels.end(),
                   [](const Level& a, const Level& b) { return a.variable > b.variable; });
  const auto [first, last] = level_range(request, levels.size());
  const auto begin = levels.begin() + static_cast<std::ptrdiff_t>(first);
  Fit fit{table.name(column), {begin, begin + static_cast<std::ptrdiff_t>(last - first) + 1}, {}};
  fit.judgement = judge(fit.levels, request.order.value_or(not_estimated), request.options);
  add_to_reason(fit, request, first, levels.size());
  return fit;
}

}  // namespace

Verdict FitRequest::wanted() const {
  return !order ? Verdict::determined : *order == 0.0 ? Verdict::stagnates : Verdict::confirmed;
}

Fits fit_table(const FitRequest& request) {
  require_usable(request);
  const NumberTable table(request.file);
  const std::vector<Level> levels = read_levels(table, request);
  const Columns columns = choose_columns(table, request.errors, "--error", request);
  Fits fits{request, columns.several, {}, columns.left_out};
  for (const std::size_t column : columns.chosen) {
    fits.columns.push_back(fit_column(table, column, levels, request));
  }
  return fits;
}

}  // namespace acstudy
