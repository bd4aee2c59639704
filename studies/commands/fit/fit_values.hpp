#pragma once

/// @file
/// acstudy fit --value | --difference: the judgement of values whose exact solution is not known.

#include <string>
#include <vector>

#include "reports/judging/values.hpp"
#include "studies/commands/fit/fit.hpp"

namespace acstudy {

/// The judgement of one column of values, or of differences of successive levels.
struct ValueFit {
  std::string column;
  std::vector<Value> values;  ///< those that were asked for, coarse to fine; of differences none
  ValueJudgement judgement;
};
using ValueFits = JudgedColumns<ValueFit>;

/// Reads a table and judges the columns that `values` or `differences` of the request name. A difference stands in the
/// row of the coarser of its two levels, or of the finer: then the row of the finest level, or of the coarsest, is
/// empty. The row of the finest level may be absent where the variables have one ratio.
/// @throws InputError
ValueFits fit_values(const FitRequest& request);

/// Levels, estimates, verdict and reason of every column, for people.
std::string as_text(const ValueFits& fits);

/// The same as one JSON object, with an array `columns` if several were asked for; null for what is not finite.
std::string as_json(const ValueFits& fits);

}  // namespace acstudy
