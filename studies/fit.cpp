#include "studies/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "studies/json_form.hpp"
#include "studies/study_file.hpp"

namespace acstudy {

namespace {

/// A value in a line, and the column of its first character.
struct Field {
  std::string text;
  std::size_t column;
};

/// Splits at every `separator`, or at runs of blanks and tabs if it is a blank.
std::vector<Field> split(const std::string& line, char separator) {
  constexpr const char* blanks = " \t";
  std::vector<Field> fields;
  std::size_t begin = 0;
  while (begin <= line.size()) {
    if (separator == ' ' && (begin = line.find_first_not_of(blanks, begin)) == std::string::npos) break;
    const std::size_t end =
        std::min(separator == ' ' ? line.find_first_of(blanks, begin) : line.find(separator, begin), line.size());
    const std::size_t first = std::min(line.find_first_not_of(blanks, begin), end);
    const std::size_t last = line.find_last_not_of(blanks, end == 0 ? 0 : end - 1);
    fields.push_back({first < end ? line.substr(first, last - first + 1) : "", first + 1});
    begin = end + 1;
  }
  return fields;
}

/// The lines of a table without comments, and its separator, which the header shows.
class Table {
 public:
  explicit Table(const std::string& file) : file_(file), in_(file, std::ios::binary) {
    if (!in_ || in_.peek() == std::ifstream::traits_type::eof()) {
      throw InputError(
          fmt::format("{}: cannot read a table there; name a file whose first line names its columns", file));
    }
    if (!next()) fail(1, "the table has no header; write the names of the columns in its first line");
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (line_.starts_with(byte_order_mark)) line_.erase(0, byte_order_mark.size());
    separator_ = line_.find(';') != std::string::npos ? ';' : line_.find(',') != std::string::npos ? ',' : ' ';
    header_ = fields();
    for (Field& name : header_) {
      if (name.text.size() >= 2 && name.text.front() == '"' && name.text.back() == '"') {
        name.text = name.text.substr(1, name.text.size() - 2);
      }
    }
  }

  /// Goes on to the next line that has values.
  bool next() {
    while (std::getline(in_, line_)) {
      ++number_;
      line_.erase(std::min(line_.find('#'), line_.size()));
      line_.erase(line_.find_last_not_of(" \t\r") + 1);
      if (!line_.empty()) return true;
    }
    return false;
  }

  std::vector<Field> fields() const { return split(line_, separator_); }

  /// Index of the column with this name.
  std::size_t column(const std::string& name) const {
    std::string names;
    std::size_t found = header_.size();
    for (std::size_t i = 0; i < header_.size(); ++i) {
      names += (i > 0 ? ", " : "") + header_[i].text;
      if (header_[i].text != name) continue;
      if (found < header_.size()) fail(header_[i].column, fmt::format("a second column \"{}\"; name each once", name));
      found = i;
    }
    if (found == header_.size()) {
      fail(1, fmt::format("no column \"{}\"; the columns are {}; choose with --variable, --error and --weight", name,
                          names));
    }
    return found;
  }

  std::size_t width() const { return header_.size(); }

  [[noreturn]] void fail(std::size_t column, const std::string& what) const {
    throw InputError(fmt::format("{}:{}:{}: {}", file_, std::max(number_, 1), column, what));
  }

  double number(const Field& field, const std::string& name) const {
    const std::size_t sign = field.text.starts_with('+') ? 1 : 0;
    const char* const end = field.text.data() + field.text.size();
    double value = 0.0;
    const auto read = std::from_chars(field.text.data() + sign, end, value);
    if (read.ec != std::errc() || read.ptr != end) {
      fail(field.column,
           fmt::format("{} = \"{}\"; not a number that a double can hold; write one such as 1.5e-3, nan or inf", name,
                       field.text));
    }
    return value;
  }

  double positive(const Field& field, const std::string& name) const {
    const double value = number(field, name);
    if (!std::isfinite(value) || !(value > 0.0)) {
      fail(field.column,
           fmt::format("{} = {}; it must be positive and finite; correct it or leave the row out", name, field.text));
    }
    return value;
  }

 private:
  std::string file_;
  std::ifstream in_;
  std::string line_;
  int number_ = 0;
  char separator_ = ' ';
  std::vector<Field> header_;
};

std::vector<Level> read_levels(const FitRequest& request) {
  Table table(request.file);
  const std::size_t variable = table.column(request.variable), error = table.column(request.error);
  const std::size_t weight = request.weight.empty() ? table.width() : table.column(request.weight);
  std::vector<Level> levels;
  while (table.next()) {
    const std::vector<Field> row = table.fields();
    if (row.size() != table.width()) {
      table.fail(1, fmt::format("{} value(s), but the header names {} column(s); write one value for each", row.size(),
                                table.width()));
    }
    Level level{table.positive(row[variable], request.variable), table.number(row[error], request.error)};
    if (weight < row.size()) level.weight = table.positive(row[weight], request.weight);
    levels.push_back(level);
  }
  if (levels.empty()) table.fail(1, "the table has a header and no rows; write a row for each level");
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
  return json_form::pretty(out) + "\n";
}

}  // namespace acstudy
