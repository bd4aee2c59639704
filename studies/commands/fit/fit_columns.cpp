#include "studies/commands/fit/fit_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "studies/reading/input_error.hpp"

namespace acstudy {

namespace {

void require_positive(const char* option, const std::optional<double>& value, const char* remedy) {
  if (!value || (std::isfinite(*value) && *value > 0.0)) return;
  throw InputError(fmt::format("{} = {}; it must be positive and finite; write {}", option, *value, remedy));
}

}  // namespace

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

Columns choose_columns(const NumberTable& table, const std::vector<std::string>& names_asked, std::string_view option,
                       const FitRequest& request) {
  Columns columns;
  const auto add = [&](std::string name) {
    name.erase(0, name.find_first_not_of(' '));
    name.erase(name.find_last_not_of(' ') + 1);
    columns.chosen.push_back(table.column(name, option));
  };
  for (const std::string& names : names_asked) {
    if (table.has(names)) {
      add(names);
    } else if (names == "all") {
      columns.several = true;
      for (std::size_t i = 0; i < table.columns(); ++i) {
        const std::string& name = table.name(i);
        if (name.empty() || name == request.variable || name == request.count || name == request.weight) continue;
        if (const auto row = table.first_without_number(i)) {
          columns.left_out.push_back(table.place_of(*row, i));
        } else {
          columns.chosen.push_back(i);
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
  if (columns.chosen.empty()) {
    throw InputError(fmt::format("{} all; no column but those of variable, count and weight holds numbers", option));
  }
  columns.several = columns.several || columns.chosen.size() > 1;
  return columns;
}

std::vector<double> variables_of(const NumberTable& table, const FitRequest& request) {
  const bool counts = !request.count.empty();
  const std::size_t column =
      counts ? table.column(request.count, "--count") : table.column(request.variable, "--variable");
  std::vector<double> variables;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double value = table.positive(row, column);
    variables.push_back(counts ? std::pow(value, -1.0 / request.dimension) : value);
  }
  return variables;
}

std::pair<std::size_t, std::size_t> level_range(const FitRequest& request, std::size_t levels) {
  const std::string& text = request.levels;
  if (text.empty()) return {0, levels - 1};
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

std::vector<std::size_t> coarse_to_fine(const std::vector<double>& variables) {
  std::vector<std::size_t> rows(variables.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) { return variables[a] > variables[b]; });
  return rows;
}

}  // namespace acstudy
