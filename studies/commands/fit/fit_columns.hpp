#pragma once

/// @file
/// What acstudy fit reads of a table, whether its columns hold errors or values.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "studies/commands/fit/fit.hpp"
#include "studies/commands/fit/number_table.hpp"

namespace acstudy {

/// Throws an InputError where an option has a value that none can have.
void require_usable(const FitRequest& request);

struct Columns {
  std::vector<std::size_t> chosen;
  bool several = false;               ///< several were asked for, even if there is only one
  std::vector<std::string> left_out;  ///< what "all" leaves out and why
};

/// The columns that `option` of the command line asks for by `names`. A name that a column has is that column, whatever
/// commas it has. @throws InputError
Columns choose_columns(const NumberTable& table, const std::vector<std::string>& names, std::string_view option,
                       const FitRequest& request);

/// The variable of each row, from counts if these were asked for. @throws InputError
std::vector<double> variables_of(const NumberTable& table, const FitRequest& request);

/// First and last level, from 0, of `--levels`: all if it was not given. @throws InputError
std::pair<std::size_t, std::size_t> level_range(const FitRequest& request, std::size_t levels);

/// The rows in the order of their levels, coarse to fine.
std::vector<std::size_t> coarse_to_fine(const std::vector<double>& variables);

}  // namespace acstudy
