#include "studies/commands/fit/fit_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/commands/fit/fit_columns.hpp"
#include "studies/reading/input_error.hpp"

namespace acstudy {

namespace {

/// The rows of a table that were asked for, coarse to fine.
struct Rows {
  std::vector<double> variables;  ///< of all rows of the table
  std::vector<std::size_t> chosen;
};

std::vector<Value> read_values(const NumberTable& table, std::size_t column, const Rows& rows) {
  const std::vector<Printed> printed = table.numbers(column);
  std::vector<Value> values;
  for (const std::size_t row : rows.chosen) {
    values.push_back({rows.variables[row], printed[row].value, printed[row].half_unit});
  }
  return values;
}

/// The variable of a finest level that has no row: one ratio further.
double next_variable(const NumberTable& table, std::size_t column, const Rows& rows) {
  const std::vector<std::size_t>& chosen = rows.chosen;
  const auto at = [&](std::size_t i) { return rows.variables[chosen[i]]; };
  const std::size_t last = chosen.size() - 1;
  constexpr double same = 0.01;  // variables are printed with few digits
  bool steady = last > 0;
  for (std::size_t i = 1; i < last; ++i) steady = steady && std::abs(at(i) / at(i + 1) / (at(0) / at(1)) - 1.0) < same;
  if (!steady) {
    table.refuse(chosen[last], column,
                 "a difference to a level without a row, and the variables have no one ratio; add a row for the finest "
                 "level, its difference empty");
  }
  return at(last) * at(last) / at(last - 1);
}

std::vector<Difference> read_differences(const NumberTable& table, std::size_t column, const Rows& rows) {
  const std::vector<std::size_t>& chosen = rows.chosen;
  const bool to_finer = !table.blank(chosen.front(), column);  // or from the coarser level to this one
  const std::size_t left_out = to_finer ? chosen.back() : chosen.front();
  const bool absent = !table.blank(left_out, column);
  const std::vector<Printed> printed = table.numbers(column, absent ? std::nullopt : std::optional(left_out));
  std::vector<Difference> differences;
  for (std::size_t i = 0; i + 1 < chosen.size(); ++i) {
    const Printed& difference = printed[chosen[to_finer ? i : i + 1]];
    differences.push_back(
        {rows.variables[chosen[i]], rows.variables[chosen[i + 1]], difference.value, difference.half_unit});
  }
  if (absent) {
    const Printed& difference = printed[chosen.back()];
    differences.push_back(
        {rows.variables[chosen.back()], next_variable(table, column, rows), difference.value, difference.half_unit});
  }
  return differences;
}

}  // namespace

ValueFits fit_values(const FitRequest& request) {
  require_usable(request);
  const NumberTable table(request.file);
  Rows rows{variables_of(table, request), {}};
  const std::vector<std::size_t> all = coarse_to_fine(rows.variables);
  const auto [first, last] = level_range(request, all.size());
  rows.chosen.assign(all.begin() + static_cast<std::ptrdiff_t>(first),
                     all.begin() + static_cast<std::ptrdiff_t>(last) + 1);

  const bool values = !request.values.empty();
  const Columns columns = choose_columns(table, values ? request.values : request.differences,
                                         values ? "--value" : "--difference", request);
  const double order = request.order.value_or(not_estimated);
  ValueFits fits{request, columns.several, {}, columns.left_out};
  for (const std::size_t column : columns.chosen) {
    ValueFit fit{table.name(column), {}, {}};
    if (values) {
      fit.values = read_values(table, column, rows);
      fit.judgement = judge_values(fit.values, order, request.options);
    } else {
      fit.judgement = judge_differences(read_differences(table, column, rows), order, request.options);
    }
    if (!request.levels.empty()) {
      fit.judgement.reason += fmt::format("; levels {} to {} of {}, as asked", first + 1, last + 1, all.size());
    }
    fits.columns.push_back(std::move(fit));
  }
  return fits;
}

}  // namespace acstudy
