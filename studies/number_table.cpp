#include "studies/number_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "studies/input_error.hpp"

namespace acstudy {

/// Splits at every `separator`, or at runs of blanks and tabs if it is a blank.
std::vector<NumberTable::Cell> NumberTable::split(const std::string& line, char separator) {
  constexpr const char* blanks = " \t";
  std::vector<Cell> cells;
  std::size_t begin = 0;
  while (begin <= line.size()) {
    if (separator == ' ' && (begin = line.find_first_not_of(blanks, begin)) == std::string::npos) break;
    const std::size_t end =
        std::min(separator == ' ' ? line.find_first_of(blanks, begin) : line.find(separator, begin), line.size());
    const std::size_t first = std::min(line.find_first_not_of(blanks, begin), end);
    const std::size_t last = line.find_last_not_of(blanks, end == 0 ? 0 : end - 1);
    cells.push_back({first < end ? line.substr(first, last - first + 1) : "", first + 1});
    begin = end + 1;
  }
  return cells;
}

NumberTable::NumberTable(const std::string& file) : file_(file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || in.peek() == std::ifstream::traits_type::eof()) {
    throw InputError(
        fmt::format("{}: cannot read a table there; name a file whose first line names its columns", file));
  }
  char separator = ' ';
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (number == 1 && line.starts_with(byte_order_mark)) line.erase(0, byte_order_mark.size());
    line.erase(std::min(line.find('#'), line.size()));
    line.erase(line.find_last_not_of(" \t\r") + 1);
    if (line.empty()) continue;
    if (header_.empty()) {
      separator = line.find(';') != std::string::npos ? ';' : line.find(',') != std::string::npos ? ',' : ' ';
      header_ = split(line, separator);
      for (Cell& name : header_) {
        if (name.text.size() >= 2 && name.text.front() == '"' && name.text.back() == '"') {
          name.text = name.text.substr(1, name.text.size() - 2);
        }
      }
      continue;
    }
    std::vector<Cell> cells = split(line, separator);
    if (cells.size() != header_.size()) {
      fail(number, 1,
           fmt::format("{} value(s), but the header names {} column(s); write one value for each", cells.size(),
                       header_.size()));
    }
    rows_.push_back({number, std::move(cells)});
  }
  if (header_.empty()) fail(1, 1, "the table has no header; write the names of the columns in its first line");
  for (const Cell& name : header_) {
    const auto same = [&name](const Cell& other) { return other.text == name.text && other.place < name.place; };
    if (std::any_of(header_.begin(), header_.end(), same)) {
      fail(1, name.place, fmt::format("a second column \"{}\"; name each once", name.text));
    }
  }
  if (rows_.empty()) fail(1, 1, "the table has a header and no rows; write a row for each level");
}

void NumberTable::fail(int line, std::size_t place, const std::string& what) const {
  throw InputError(fmt::format("{}:{}:{}: {}", file_, line, place, what));
}

void NumberTable::refuse(std::size_t row, std::size_t column, const std::string& what) const {
  const Cell& cell = rows_[row].cells[column];
  fail(rows_[row].line, cell.place, fmt::format("{} = {}; {}", name(column), cell.text, what));
}

std::size_t NumberTable::column(const std::string& name) const {
  const auto found =
      std::find_if(header_.begin(), header_.end(), [&name](const Cell& cell) { return cell.text == name; });
  if (found != header_.end()) return static_cast<std::size_t>(found - header_.begin());
  std::string names;
  for (const Cell& cell : header_) names += (names.empty() ? "" : ", ") + cell.text;
  fail(1, 1,
       fmt::format("no column \"{}\"; the columns are {}; choose with --variable, --error and --weight", name, names));
}

Printed NumberTable::number(std::size_t row, std::size_t column) const {
  const std::string& text = rows_[row].cells[column].text;
  const std::size_t sign = text.starts_with('+') ? 1 : 0;
  const char* const end = text.data() + text.size();
  double value = 0.0;
  const auto read = std::from_chars(text.data() + sign, end, value);
  if (read.ec != std::errc() || read.ptr != end) {
    fail(rows_[row].line, rows_[row].cells[column].place,
         fmt::format("{} = \"{}\"; not a number that a double can hold; write one such as 1.5e-3, nan or inf",
                     name(column), text));
  }
  return {value, 0.0};
}

double NumberTable::positive(std::size_t row, std::size_t column) const {
  const double value = number(row, column).value;
  if (!std::isfinite(value) || !(value > 0.0)) {
    refuse(row, column, "it must be positive and finite; correct it or leave the row out");
  }
  return value;
}

}  // namespace acstudy
