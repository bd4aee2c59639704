#include "studies/commands/table/error_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>
#include <set>

#include "mms/expression.hpp"
#include "studies/reading/input_error.hpp"

namespace acstudy {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

double error_of(const CaseResult& result, Norm norm) {
  return norm == Norm::max ? result.error_linf : norm == Norm::l1 ? result.error_l1 : result.error_l2;
}

ErrorColumn column_of(const FindingRecord& record, Norm norm) {
  const Finding& finding = record.finding;
  const Judgement& judged = finding.judgement;
  ErrorColumn column{.label = finding.cases ? finding.subject : finding.statement + ": " + finding.subject,
                     .check = finding.label(),
                     .levels = {},
                     .order = norm == Norm::max ? judged.order : none,
                     .low = judged.low,
                     .high = judged.high,
                     .verdict = judged.verdict};
  for (std::size_t i = 0; i < finding.points.size(); ++i) {
    const Point& p = finding.points[i];
    ErrorColumn::Level level{p.N, p.h, p.delta, p.value, none};
    if (norm != Norm::max) level.error = error_of(record.cases.at(i).result, norm);
    if (i > 0) {
      const double before = column.levels.back().error, coarser = finding.points[i - 1].variable;
      level.order = std::log(before / level.error) / std::log(coarser / p.variable);
    }
    column.levels.push_back(level);
  }
  return column;
}

const ErrorColumn::Level* level_at(const ErrorColumn& column, std::int64_t N) {
  const auto found =
      std::find_if(column.levels.begin(), column.levels.end(), [N](const auto& level) { return level.N == N; });
  return found == column.levels.end() ? nullptr : &*found;
}

/// "1.23e-04" as an author writes it.
std::string in_latex(double error) {
  if (!std::isfinite(error)) return "--";
  const std::string text = fmt::format("{:.2e}", error);
  const std::size_t e = text.find('e');
  return fmt::format("${}\\cdot 10^{{{}}}$", text.substr(0, e), std::stoi(text.substr(e + 1)));
}

std::string order_text(double order, const char* nothing) {
  return std::isfinite(order) ? fmt::format("{:.2f}", order) : nothing;
}

std::string latex_escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (std::string_view("_&%#${}").find(c) != std::string_view::npos) {
      out += '\\';
      out += c;
    } else if (c == '^') {
      out += "\\textasciicircum{}";
    } else {
      out += c;
    }
  }
  return out;
}

/// "delta = sqrt(h)" as a formula, other conditions as text.
std::string conditions_in_latex(const std::string& conditions) {
  if (!std::regex_match(conditions, std::regex("delta = [-+*/^(). 0-9a-zA-Z]+"))) return latex_escaped(conditions);
  std::string formula = std::regex_replace(conditions, std::regex("sqrt\\(([^()]*)\\)"), "\\sqrt{$1}");
  formula = std::regex_replace(formula, std::regex("\\bdelta\\b"), "\\delta");
  return "$" + std::regex_replace(formula, std::regex("\\*"), "\\,") + "$";
}

std::string csv_quoted(const std::string& text) {
  return "\"" + std::regex_replace(text, std::regex("\""), "\"\"") + "\"";
}

}  // namespace

std::vector<std::int64_t> ErrorTable::particles() const {
  std::set<std::int64_t> all;
  for (const ErrorColumn& column : columns) {
    for (const auto& level : column.levels) all.insert(level.N);
  }
  return {all.begin(), all.end()};
}

std::vector<ErrorTable> error_tables(const ResultRecord& record, Norm norm, const std::string& file) {
  std::vector<ErrorTable> tables;
  for (const FindingRecord& one : record.findings) {
    if (one.finding.test != Test::order && one.finding.test != Test::rate) continue;
    if (norm != Norm::max && !one.finding.cases) {
      throw InputError(fmt::format("{}: {} is no error of a run, and has no other norm; leave --norm out", file,
                                   in_quotes(one.finding.label())));
    }
    const std::string conditions = one.finding.conditions();
    auto table = std::find_if(tables.begin(), tables.end(),
                              [&](const ErrorTable& known) { return known.conditions == conditions; });
    if (table == tables.end()) table = tables.insert(tables.end(), {conditions, {}});
    table->columns.push_back(column_of(one, norm));
  }
  if (tables.empty()) {
    throw InputError(
        fmt::format("{}: nothing in it vanishes with an order; name the results of a convergence study", file));
  }
  return tables;
}

std::string with_uncertain_digits(double value, double low, double high) {
  const double half = std::max(value - low, high - value);
  if (!std::isfinite(value)) return "-";
  if (!std::isfinite(half) || half <= 0.0) return fmt::format("{:.3g}", value);
  const double exponent = std::floor(std::log10(half));
  int places = -static_cast<int>(exponent);
  if (half / std::pow(10.0, exponent) < 1.95) ++places;  // a first digit of 1 says too little alone
  places = std::max(places, 0);
  return fmt::format("{:.{}f}({:.0f})", value, places, half * std::pow(10.0, places));
}

std::string as_markdown(const std::vector<ErrorTable>& tables) {
  std::string out;
  for (const ErrorTable& table : tables) {
    if (!out.empty()) out += "\n";
    out += table.conditions + "\n\n| N |";
    for (const ErrorColumn& column : table.columns) out += fmt::format(" {} | order |", column.label);
    out += "\n|--:|";
    for (std::size_t i = 0; i < table.columns.size(); ++i) out += "--:|--:|";
    for (const std::int64_t N : table.particles()) {
      out += fmt::format("\n| {} |", N);
      for (const ErrorColumn& column : table.columns) {
        const auto* const level = level_at(column, N);
        out += level == nullptr ? "  |  |" : fmt::format(" {:.2e} | {} |", level->error, order_text(level->order, ""));
      }
    }
    out += "\n| all |";
    for (const ErrorColumn& column : table.columns) {
      out += fmt::format(" {} | {} |", name_of(column.verdict),
                         with_uncertain_digits(column.order, column.low, column.high));
    }
    out += "\n";
  }
  return out;
}

std::string as_latex(const std::vector<ErrorTable>& tables) {
  std::string out = "% \\usepackage{booktabs}\n";
  for (const ErrorTable& table : tables) {
    out += fmt::format("\n% {}\n\\begin{{tabular}}{{r*{{{}}}{{cc}}}}\n\\toprule\n", table.conditions,
                       table.columns.size());
    const std::size_t width = 2 * table.columns.size();
    out += fmt::format("& \\multicolumn{{{}}}{{c}}{{{}}} \\\\\n", width, conditions_in_latex(table.conditions));
    std::string rules;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      out += fmt::format("& \\multicolumn{{2}}{{c}}{{{}}}\n", latex_escaped(table.columns[i].label));
      rules += fmt::format("\\cmidrule(lr){{{}-{}}}", 2 * i + 2, 2 * i + 3);
    }
    out += "\\\\\n" + rules + "\n$N$";
    for (std::size_t i = 0; i < table.columns.size(); ++i) out += " & error & order";
    out += " \\\\\n\\midrule\n";
    for (const std::int64_t N : table.particles()) {
      out += fmt::format("{}", N);
      for (const ErrorColumn& column : table.columns) {
        const auto* const level = level_at(column, N);
        out +=
            level == nullptr ? " & &" : fmt::format(" & {} & {}", in_latex(level->error), order_text(level->order, ""));
      }
      out += " \\\\\n";
    }
    out += "\\midrule\norder";
    for (const ErrorColumn& column : table.columns) {
      out += fmt::format(" & & {}", with_uncertain_digits(column.order, column.low, column.high));
    }
    out += " \\\\\n\\bottomrule\n\\end{tabular}\n";
  }
  return out;
}

std::string as_csv(const std::vector<ErrorTable>& tables) {
  const auto number = [](double value) { return std::isfinite(value) ? fmt::format("{}", value) : std::string(); };
  std::string out = "conditions,scheme,N,h,delta,error,order,fitted_order,low,high,verdict\n";
  for (const ErrorTable& table : tables) {
    for (const ErrorColumn& column : table.columns) {
      for (const auto& level : column.levels) {
        out += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", csv_quoted(table.conditions), csv_quoted(column.label),
                           level.N, number(level.h), number(level.delta), number(level.error), number(level.order),
                           number(column.order), number(column.low), number(column.high), name_of(column.verdict));
      }
    }
  }
  return out;
}

}  // namespace acstudy
