#pragma once

/// @file
/// acstudy fit: the judgement of a table of errors, wherever they come from.

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "reports/judging/orders.hpp"

namespace acstudy {

/// A table, the names of its columns, and what is known of its errors.
struct FitRequest {
  std::string file;                             ///< "-": standard input
  std::string variable = "h";                   ///< column of the variable
  std::string count;                            ///< in its place: column of a number n of cells; h = n^(-1/dimension)
  double dimension = 1.0;                       ///< of the space that the cells fill
  std::vector<std::string> errors = {"error"};  ///< each one column, several with commas, or "all"
  std::string weight;                           ///< empty: all levels weigh the same
  std::string levels;                           ///< "A:B", "A:" or ":B", from 1, coarse to fine; empty: all
  std::optional<double> order;                  ///< 0: the error must settle
  JudgeOptions options = {};
  std::vector<std::string> values, differences;  ///< in place of errors: columns of values, of their differences

  Verdict wanted() const;  ///< what passes
};

/// The columns of a table that were asked for, each judged: `Judged` has the name of its `column` and a `judgement`.
template <class Judged>
struct JudgedColumns {
  FitRequest request;
  bool several = false;  ///< several columns were asked for, even if there is only one
  std::vector<Judged> columns;
  std::vector<std::string> left_out;  ///< what "all" leaves out and why

  /// True if every column has the order that was asked for; for order 0, if it settles; without an order, if it
  /// determines one.
  bool passes() const {
    return std::all_of(columns.begin(), columns.end(),
                       [this](const Judged& one) { return meets(one.judgement.verdict, request.wanted()); });
  }
};

/// The judgement of one column of errors.
struct Fit {
  std::string column;
  std::vector<Level> levels;  ///< those that were asked for, coarse to fine
  Judgement judgement;
};
using Fits = JudgedColumns<Fit>;

/// Reads a table and judges its errors, in columns that NumberTable reads. Rows may stand in any order. An error may be
/// nan or inf, a variable, a count or a weight must be positive. Where the variable grows as the errors fall, and is
/// whole as a number of cells, the verdict is `inconclusive` and its reason the remedy.
/// @throws InputError
Fits fit_table(const FitRequest& request);

/// Levels, estimates, verdict and reason of every column, for people.
std::string as_text(const Fits& fits);

/// The same as one JSON object, with an array `columns` if several were asked for; null for what is not finite.
std::string as_json(const Fits& fits);

}  // namespace acstudy
