#pragma once

/// @file
/// Numbers as text, with what their print tells of their digits.

#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace acstudy {

/// A number as it was printed. Places are powers of ten: 0.0250 begins at -2 and ends at -4.
struct PrintedNumber {
  double value;
  int first = 0, last = 0;  ///< places of the first and the last significant digit
  int digits = 0;           ///< from the first to the last one that is not a dropped zero; 0: nothing known
  bool point = false;       ///< printed with a decimal point or an exponent
  bool whole = false;       ///< printed without decimals, or with the lone zero of Python's 250.0
  bool zeros = false;       ///< ends in a zero that was printed as a digit
};

/// Reads a number: decimal, a ratio such as 1/16, with an exponent as C (1e-3) or Fortran (1.0D-03, 1.0-103) writes it,
/// nan or inf as C or Windows (1.#QNAN, -1.#IND, 1.#INF) writes them. Nothing if it is none that a double can hold.
std::optional<PrintedNumber> read_number(std::string_view text);

/// Half a unit of the last printed digit of each number of a column; NumberTable::numbers has the rule. Digits that a
/// product in double precision leaves behind, as in 8.810000000000001e-22, are none.
std::vector<double> half_units(std::span<const PrintedNumber> column);

/// True if the text is a number once its comma is a point.
bool has_decimal_comma(std::string_view text);

}  // namespace acstudy
