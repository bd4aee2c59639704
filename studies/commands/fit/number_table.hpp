#pragma once

/// @file
/// Tables of numbers as programs and people write them: named columns, a row per level.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace acstudy {

/// A number and half a unit of its last printed digit, which its print leaves open. 0 where nothing is known of that.
struct Printed {
  double value;
  double half_unit;
};

/// A table of numbers, read as a whole.
///
/// Its first line names the columns; numpy.savetxt writes it as a comment. Semicolons, commas, tabs, bars (Markdown),
/// ampersands (TeX) or blanks separate values, whichever splits all lines alike. '#' begins a comment at the begin of a
/// line or after a blank, '%' only at the begin of a line. Rules and rows without any value are left out, quotes are
/// taken off. A cell is read when it is asked for: what stands in other columns is of no matter.
class NumberTable {
 public:
  /// @param file  "-": standard input, which messages call <stdin>
  /// @throws InputError, also for UTF-16 and for line ends that are a carriage return alone
  explicit NumberTable(const std::string& file);

  std::size_t columns() const { return header_.size(); }
  std::size_t rows() const { return rows_.size(); }
  const std::string& name(std::size_t column) const { return header_[column].text; }
  bool has(std::string_view name) const;

  /// Index of the column with this name, which `option` of the command line has chosen. @throws InputError
  std::size_t column(const std::string& name, std::string_view option) const;

  /// The number in a cell: decimal, a ratio such as 1/16, with an exponent as C or Fortran writes it, or nan or inf as
  /// C or Windows writes them. @throws InputError
  double number(std::size_t row, std::size_t column) const;

  /// The same, positive and finite. @throws InputError
  double positive(std::size_t row, std::size_t column) const;

  /// A whole column with what its print leaves open. Trailing zeros count as digits; but where numbers differ in length
  /// and none ends in a zero, as %g and Python print them, zeros were dropped and each has as many digits as the
  /// longest. Whole numbers without a point are exact. nan in row `except`. @throws InputError
  std::vector<Printed> numbers(std::size_t column, std::optional<std::size_t> except = {}) const;

  /// True if a cell is empty or a dash.
  bool blank(std::size_t row, std::size_t column) const;

  /// The first row whose cell in this column is no number.
  std::optional<std::size_t> first_without_number(std::size_t column) const;

  /// "LINE:COL: NAME = TEXT": where a cell is and what it says.
  std::string place_of(std::size_t row, std::size_t column) const;

  /// Throws an InputError "FILE:LINE:COL: NAME = TEXT; what".
  [[noreturn]] void refuse(std::size_t row, std::size_t column, const std::string& what) const;

  /// A cell, and the column of its first character in the line, from 1.
  struct Cell {
    std::string text;
    std::size_t place;
  };

 private:
  struct Line {
    int number;
    std::string text;
  };
  struct Row {
    int line;
    std::vector<Cell> cells;
  };

  [[noreturn]] void fail(int line, std::size_t place, const std::string& what) const;
  void require_lines(std::string_view text) const;
  void read_header(const std::vector<Line>& lines, const std::vector<Line>& comments);
  void read_row(const Line& line);

  std::string file_;
  char separator_ = ' ';
  int header_line_ = 1;
  std::vector<Cell> header_;
  std::vector<Row> rows_;
};

}  // namespace acstudy
