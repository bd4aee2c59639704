#include "studies/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <tuple>

#include "studies/input_error.hpp"
#include "studies/number_table.hpp"

namespace acstudy {

namespace {

void require_positive(const char* option, const std::optional<double>& value, const char* remedy) {
  if (!value || (std::isfinite(*value) && *value > 0.0)) return;
  throw InputError(fmt::format("{} = {}; it must be positive and finite; write {}", option, *value, remedy));
}

void require_usable(const FitRequest& request) {
  if (request.order && !(std::isfinite(*request.order) && *request.order >= 0.0)) {
    throw InputError(fmt::format(
        "--order = {}; an order must be finite and not negative; write 0 where the error must settle", *request.order));
  }
  if (!(std::isfinite(request.dimension) && request.dimension >= 1.0)) {
    throw InputError(
        fmt::format("--dimension = {}; it must be finite and at least 1; write that of the space that the cells fill",
                    request.dimension));
  }
  require_positive("--scale", request.options.scale, "the size of the solution, as the largest |u|");
  require_positive("--floor", request.options.floor, "the error that round-off, quadrature or iteration leaves");
}

/// The columns that `--error` asks for. A name that a column has is that column, whatever commas it has.
std::vector<std::size_t> error_columns(const NumberTable& table, Fits& fits) {
  const FitRequest& request = fits.request;
  std::vector<std::size_t> columns;
  const auto add = [&](std::string name) {
    name.erase(0, name.find_first_not_of(' '));
    name.erase(name.find_last_not_of(' ') + 1);
    columns.push_back(table.column(name, "--error"));
  };
  for (const std::string& names : request.errors) {
    if (table.has(names)) {
      add(names);
    } else if (names == "all") {
      fits.several = true;
      for (std::size_t i = 0; i < table.columns(); ++i) {
        const std::string& name = table.name(i);
        if (name.empty() || name == request.variable || name == request.count || name == request.weight) continue;
        if (const auto row = table.first_without_number(i)) {
          fits.left_out.push_back(table.place_of(*row, i));
        } else {
          columns.push_back(i);
        }
      }
    } else {
      for (std::size_t begin = 0; begin <= names.size();) {
        const std::size_t end = std::min(names.find(',', begin), names.size());
        add(names.substr(begin, end - begin));
        begin = end + 1;
      }
    }
  }
  if (columns.empty()) throw InputError("--error all; no column but those of variable, count and weight holds numbers");
  fits.several = fits.several || columns.size() > 1;
  return columns;
}

/// First and last level, from 0, of `--levels`.
std::pair<std::size_t, std::size_t> level_range(const std::string& text, std::size_t levels) {
  const std::size_t colon = std::min(text.find(':'), text.size());
  const auto number = [](std::string_view digits, std::size_t otherwise) -> std::size_t {
    std::size_t value = otherwise;
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return digits.empty() || (read.ec == std::errc() && read.ptr == digits.data() + digits.size()) ? value : 0;
  };
  const std::string_view view = text;
  const std::size_t first = number(view.substr(0, colon), 1);
  const std::size_t last = number(view.substr(std::min(colon + 1, text.size())), levels);
  if (colon == text.size() || text.size() == 1 || first < 1 || last < first || last > levels) {
    throw InputError(fmt::format(
        "--levels = \"{}\"; the table has levels 1, the coarsest, to {}; write A:B, A: or :B of these", text, levels));
  }
  return {first - 1, last - 1};
}

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
  const bool counts = !request.count.empty(), weighted = !request.weight.empty();
  const std::size_t variable =
      counts ? table.column(request.count, "--count") : table.column(request.variable, "--variable");
  const std::size_t weight = weighted ? table.column(request.weight, "--weight") : 0;
  std::vector<Level> levels;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double value = table.positive(row, variable);
    levels.push_back({counts ? std::pow(value, -1.0 / request.dimension) : value, not_estimated});
    if (weighted) levels.back().weight = table.positive(row, weight);
  }
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
  std::size_t first = 0, last = levels.size() - 1;
  if (!request.levels.empty()) std::tie(first, last) = level_range(request.levels, levels.size());
  const auto begin = levels.begin() + static_cast<std::ptrdiff_t>(first);
  Fit fit{table.name(column), {begin, begin + static_cast<std::ptrdiff_t>(last - first) + 1}, {}};
  fit.judgement = judge(fit.levels, request.order.value_or(not_estimated), request.options);
  add_to_reason(fit, request, first, levels.size());
  return fit;
}

}  // namespace

bool Fits::passes() const {
  const Verdict wanted = !request.order          ? Verdict::determined
                         : *request.order == 0.0 ? Verdict::stagnates
                                                 : Verdict::confirmed;
  return std::all_of(columns.begin(), columns.end(),
                     [wanted](const Fit& fit) { return meets(fit.judgement.verdict, wanted); });
}

Fits fit_table(const FitRequest& request) {
  require_usable(request);
  const NumberTable table(request.file);
  Fits fits{request, false, {}, {}};
  const std::vector<Level> levels = read_levels(table, request);
  for (const std::size_t column : error_columns(table, fits)) {
    fits.columns.push_back(fit_column(table, column, levels, request));
  }
  return fits;
}

}  // namespace acstudy
