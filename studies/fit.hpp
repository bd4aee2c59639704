#pragma once

/// @file
/// acstudy fit: the judgement of a table of errors, wherever they come from.

#include <optional>
#include <string>
#include <vector>

#include "reports/orders.hpp"

namespace acstudy {

/// A table, the names of its columns, and what theory says of it.
struct FitRequest {
  std::string file, variable = "h", error = "error";
  std::string weight;           ///< empty: all levels weigh the same
  std::optional<double> order;  ///< 0: the error must settle
};

struct Fit {
  FitRequest request;
  std::vector<Level> levels;  ///< coarse to fine
  Judgement judgement;

  /// True if an order was given and the errors have it; for order 0, if they settle.
  bool passes() const;
};

/// Reads a table and judges it. Its first line names the columns; commas, semicolons, or blanks and tabs separate them;
/// '#' begins a comment; rows may stand in any order. An error may be nan or inf, a variable or a weight must be
/// positive.
/// @throws InputError
Fit fit_table(const FitRequest& request);

/// Levels, estimates, verdict and reason, for people.
std::string as_text(const Fit& fit);

/// The same as one JSON object; null for what is not finite.
std::string as_json(const Fit& fit);

}  // namespace acstudy
