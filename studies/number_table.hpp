#pragma once

/// @file
/// Tables of numbers as programs and people write them: named columns, a row per level.

#include <cstddef>
#include <string>
#include <vector>

namespace acstudy {

/// A number and half a unit of its last printed digit: what its print leaves open. 0 if it is not finite.
struct Printed {
  double value;
  double half_unit;
};

/// A table of numbers, read as a whole. Its first line names the columns; commas, semicolons, or blanks and tabs
/// separate them; '#' begins a comment. A cell is read when it is asked for, so what stands in other columns is of no
/// matter.
class NumberTable {
 public:
  /// @throws InputError
  explicit NumberTable(const std::string& file);

  std::size_t columns() const { return header_.size(); }
  std::size_t rows() const { return rows_.size(); }

  const std::string& name(std::size_t column) const { return header_[column].text; }

  /// Index of the column with this name. @throws InputError
  std::size_t column(const std::string& name) const;

  /// The number in a cell, nan and inf included. @throws InputError
  Printed number(std::size_t row, std::size_t column) const;

  /// The same, positive and finite. @throws InputError
  double positive(std::size_t row, std::size_t column) const;

  /// Throws an InputError "FILE:LINE:COL: NAME = TEXT; what" about a cell.
  [[noreturn]] void refuse(std::size_t row, std::size_t column, const std::string& what) const;

 private:
  /// A cell, and the column of the first character of its text in the line.
  struct Cell {
    std::string text;
    std::size_t place;
  };
  struct Row {
    int line;
    std::vector<Cell> cells;
  };

  [[noreturn]] void fail(int line, std::size_t place, const std::string& what) const;
  static std::vector<Cell> split(const std::string& line, char separator);

  std::string file_;
  std::vector<Cell> header_;
  std::vector<Row> rows_;
};

}  // namespace acstudy
