#pragma once

/// @file
/// Tables of errors and orders as papers print them.

#include <cstdint>
#include <string>
#include <vector>

#include "studies/storing/result_record.hpp"

namespace acstudy {

/// Which error a table shows.
enum class Norm { max, l1, l2 };

/// The levels of one finding, and the order that the judge gives it.
struct ErrorColumn {
  struct Level {
    std::int64_t N;
    double h, delta, error;
    double order;  ///< between the level before and this one, by what theory's order is in; NaN for the first
  };
  std::string label;  ///< "Model I, local divergence, inverse"
  std::string check;  ///< the name of the whole finding
  std::vector<Level> levels;
  double order, low, high;  ///< with 95 % interval; NaN where the norm is none that is judged
  Verdict verdict;
};

/// What was found under the same conditions, a column each.
struct ErrorTable {
  std::string conditions;  ///< "delta = 4h"
  std::vector<ErrorColumn> columns;

  /// Of all columns, ascending.
  std::vector<std::int64_t> particles() const;
};

/// The tables of a result file: of errors along paths, and of whatever else vanishes with an order.
/// @throws InputError if there are none, or the norm is not max and errors are none of runs
std::vector<ErrorTable> error_tables(const ResultRecord& record, Norm norm, const std::string& file);

/// A number with the digits that its interval leaves uncertain: 0.951, [0.906, 0.996] is "0.95(5)"; "-" where nothing
/// is known. Two digits where the first is 1.
std::string with_uncertain_digits(double value, double low, double high);

std::string as_markdown(const std::vector<ErrorTable>& tables);
/// With booktabs.
std::string as_latex(const std::vector<ErrorTable>& tables);
/// A row per level, all digits.
std::string as_csv(const std::vector<ErrorTable>& tables);

}  // namespace acstudy
