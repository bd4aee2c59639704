#include "studies/commands/fit/number_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <sstream>

#include "studies/commands/fit/printed_number.hpp"
#include "studies/reading/input_error.hpp"

namespace acstudy {

namespace {

using Cells = std::vector<NumberTable::Cell>;

constexpr std::string_view blanks = " \t";
/// In the order in which they are tried.
constexpr std::string_view separators = ";,\t|& ";

std::string read_text(const std::string& file) {
  std::ifstream stored;
  if (file != "-") stored.open(file, std::ios::binary);
  std::istream& in = file == "-" ? std::cin : stored;
  std::ostringstream text;
  text << in.rdbuf();  // of a folder nothing, where an iterator would throw
  return text.str();
}

/// The value that begins at `begin`, from quotes if it stands in some, and where it ends.
NumberTable::Cell cell_at(const std::string& line, std::size_t begin, char separator, std::size_t& end) {
  const auto is_end = [&](std::size_t i) {
    return i >= line.size() || line[i] == separator || (separator == ' ' && line[i] == '\t');
  };
  const std::size_t first = std::min(line.find_first_not_of(separator == '\t' ? " " : blanks, begin), line.size());
  if (first < line.size() && (line[first] == '"' || line[first] == '\'')) {
    const std::size_t close = line.find(line[first], first + 1);
    const std::size_t next = close == std::string::npos ? close : line.find_first_not_of(' ', close + 1);
    if (close != std::string::npos && (is_end(close + 1) || is_end(next))) {
      end = is_end(close + 1) ? close + 1 : std::min(next, line.size());
      return {line.substr(first + 1, close - first - 1), first + 1};
    }
  }
  for (end = std::min(first, line.size()); !is_end(end);) ++end;
  if (first >= end) return {"", begin + 1};
  const std::size_t last = line.find_last_not_of(blanks, end - 1);
  return {line.substr(first, last - first + 1), first + 1};
}

/// Splits at every `separator`, or at runs of blanks and tabs if it is a blank.
Cells split(const std::string& line, char separator) {
  Cells cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    if (separator == ' ' && (begin = line.find_first_not_of(blanks, begin)) == std::string::npos) break;
    std::size_t end = 0;
    cells.push_back(cell_at(line, begin, separator, end));
    begin = end + 1;
  }
  return cells;
}

/// The line without a comment at its end, and without the end of a row of TeX.
std::string without_end(std::string line) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (line[i] != '#' || quoted || (i > 0 && blanks.find(line[i - 1]) == std::string_view::npos)) continue;
    line.erase(i);
  }
  if (line.find('&') != std::string::npos) line.erase(std::min(line.find("\\\\"), line.size()));
  return line;
}

/// True for what has no values: rules of Markdown, TeX and plain text, and rows of separators.
bool is_ornament(const std::string& line) {
  if (line.find_first_not_of(";,\t|& \"") == std::string::npos) return true;
  const char first = line[line.find_first_not_of(blanks)];
  if (first == '\\') return true;
  return line.find_first_not_of("-+|:= \t") == std::string::npos &&
         (first == '|' || first == '+' || line.find("---") != std::string::npos ||
          line.find("===") != std::string::npos);
}

bool mostly_numbers(const Cells& cells) {
  const auto count = std::count_if(cells.begin(), cells.end(), [](const auto& c) { return read_number(c.text); });
  return 2 * count > static_cast<std::ptrdiff_t>(cells.size());
}

}  // namespace

NumberTable::NumberTable(const std::string& file) : file_(file == "-" ? "<stdin>" : file) {
  std::string text = read_text(file);
  if (text.empty()) {
    throw InputError(
        fmt::format("{}: cannot read a table there; name a file whose first line names its columns", file_));
  }
  require_lines(text);
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.erase(0, byte_order_mark.size());

  std::vector<Line> lines, comments;
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    ++number;
    line.erase(line.find_last_not_of('\r') + 1);
    const std::size_t first = line.find_first_not_of(blanks);
    if (first != std::string::npos && (line[first] == '#' || line[first] == '%')) {
      if (lines.empty()) comments.push_back({number, line});
      continue;
    }
    line = without_end(line);
    if (!is_ornament(line)) lines.push_back({number, line});
  }
  if (lines.empty()) fail(1, 1, "the table has no header; write the names of the columns in its first line");
  read_header(lines, comments);
  for (const Line& line : lines) {
    if (line.number > header_line_) read_row(line);
  }
  if (rows_.empty()) {
    fail(header_line_, 1, "the table has a header and no rows; write a row for each level");
  }
}

void NumberTable::require_lines(std::string_view text) const {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF") || text.find('\0') != std::string_view::npos) {
    fail(1, 1, "the table is written in UTF-16, or it is no text; save it as UTF-8");
  }
  int line = 1;
  std::size_t begin = 0;
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    if (text[i] == '\r' && text[i + 1] != '\n' && text[i + 1] != '\r') {
      fail(line, i - begin + 1,
           "a carriage return (CR) alone ends a line; save the table with line feeds (LF or CR LF)");
    }
    if (text[i] == '\n') {
      ++line;
      begin = i + 1;
    }
  }
}

void NumberTable::read_header(const std::vector<Line>& lines, const std::vector<Line>& comments) {
  const std::string& first = lines.front().text;
  std::ptrdiff_t most = -1;
  for (const char candidate : separators) {
    if (candidate != ' ' && first.find(candidate) == std::string::npos) continue;
    if (candidate == ' ' && first.find_first_of(";,&") != std::string::npos) continue;
    const std::size_t size = split(first, candidate).size();
    const auto alike = std::count_if(lines.begin(), lines.end(),
                                     [&](const Line& line) { return split(line.text, candidate).size() == size; });
    if (alike <= most) continue;
    most = alike;
    separator_ = candidate;
  }
  header_ = split(first, separator_);
  header_line_ = lines.front().number;
  if (header_.size() < 2 || !mostly_numbers(header_)) return;
  for (auto comment = comments.rbegin(); comment != comments.rend(); ++comment) {
    std::string names = comment->text;
    const std::size_t begin = std::min(names.find_first_not_of("#% \t"), names.size());
    names.replace(0, begin, begin, ' ');  // not erased: messages name places in the line
    for (const char candidate : separators) {
      Cells cells = split(names, candidate);
      if (cells.size() != header_.size() || mostly_numbers(cells)) continue;
      header_ = std::move(cells);
      header_line_ = comment->number;
      return;
    }
  }
}

void NumberTable::read_row(const Line& line) {
  Cells cells = split(line.text, separator_);
  const Cells by_semicolons = separator_ == ',' ? split(line.text, ';') : Cells();
  const bool decimal_commas =
      by_semicolons.size() > 1 && std::any_of(by_semicolons.begin(), by_semicolons.end(),
                                              [](const Cell& cell) { return has_decimal_comma(cell.text); });
  if (decimal_commas) {
    fail(line.number, 1,
         fmt::format("\"{}\"; decimal commas, but the header is separated by commas; write points", line.text));
  }
  if (cells.size() != header_.size()) {
    fail(line.number, 1,
         fmt::format(
             "{} value(s), but the header names {} column(s); write one value for each{}", cells.size(), header_.size(),
             separator_ == ',' && line.text.find('.') == std::string::npos ? ", and points for decimal commas" : ""));
  }
  rows_.push_back({line.number, std::move(cells)});
}

void NumberTable::fail(int line, std::size_t place, const std::string& what) const {
  throw InputError(fmt::format("{}:{}:{}: {}", file_, line, place, what));
}

std::string NumberTable::place_of(std::size_t row, std::size_t column) const {
  const Cell& cell = rows_[row].cells[column];
  return fmt::format("{}:{}: {} = {}", rows_[row].line, cell.place, name(column), cell.text);
}

void NumberTable::refuse(std::size_t row, std::size_t column, const std::string& what) const {
  throw InputError(fmt::format("{}:{}; {}", file_, place_of(row, column), what));
}

bool NumberTable::has(std::string_view name) const {
  return std::any_of(header_.begin(), header_.end(), [name](const Cell& cell) { return cell.text == name; });
}

std::size_t NumberTable::column(const std::string& name, std::string_view option) const {
  std::string names;
  std::size_t found = header_.size();
  for (std::size_t i = 0; i < header_.size(); ++i) {
    names += (i > 0 ? ", " : "") + header_[i].text;
    if (header_[i].text != name) continue;
    if (found < header_.size()) {
      fail(header_line_, header_[i].place, fmt::format("a second column \"{}\"; name each once", name));
    }
    found = i;
  }
  if (found == header_.size()) {
    fail(header_line_, 1,
         mostly_numbers(header_)
             ? fmt::format("the first line holds numbers, {}; write the names of the columns in a line above", names)
             : fmt::format("no column \"{}\"; the columns are {}; name one with {}", name, names, option));
  }
  return found;
}

double NumberTable::number(std::size_t row, std::size_t column) const {
  const Cell& cell = rows_[row].cells[column];
  if (const auto number = read_number(cell.text)) return number->value;
  const std::string why = cell.text.empty() ? "the cell is empty; write a number there or leave the row out"
                          : has_decimal_comma(cell.text)
                              ? "a decimal comma; write a point"
                              : "not a number that a double can hold; write one such as 1.5e-3, nan or inf";
  fail(rows_[row].line, cell.place, fmt::format("{} = \"{}\"; {}", name(column), cell.text, why));
}

double NumberTable::positive(std::size_t row, std::size_t column) const {
  const double value = number(row, column);
  if (!std::isfinite(value) || !(value > 0.0)) {
    refuse(row, column, "it must be positive and finite; correct it or leave the row out");
  }
  return value;
}

std::vector<Printed> NumberTable::numbers(std::size_t column, std::optional<std::size_t> except) const {
  std::vector<PrintedNumber> printed;
  for (std::size_t row = 0; row < rows(); ++row) {
    if (row == except) {
      printed.push_back(*read_number("nan"));
      continue;
    }
    number(row, column);  // throws where there is none
    printed.push_back(*read_number(rows_[row].cells[column].text));
  }
  const std::vector<double> halves = half_units(printed);
  std::vector<Printed> numbers;
  for (std::size_t row = 0; row < rows(); ++row) numbers.push_back({printed[row].value, halves[row]});
  return numbers;
}

bool NumberTable::blank(std::size_t row, std::size_t column) const {
  const std::string& text = rows_[row].cells[column].text;
  return text.empty() || text == "-";
}

std::optional<std::size_t> NumberTable::first_without_number(std::size_t column) const {
  for (std::size_t row = 0; row < rows(); ++row) {
    if (!read_number(rows_[row].cells[column].text)) return row;
  }
  return {};
}

}  // namespace acstudy
