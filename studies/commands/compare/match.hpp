#pragma once

/// @file
/// Which finding, case or point of one set is that of the other.

#include <vector>

#include "studies/commands/compare/comparison.hpp"

namespace acstudy {

/// The things of two lists that are the same but for their numbers; of several of one kind the first with the first.
/// What only `after` has comes last.
std::vector<Matched<CaseRecord>> match(const std::vector<CaseRecord>& before, const std::vector<CaseRecord>& after);
std::vector<Matched<Point>> match(const std::vector<Point>& before, const std::vector<Point>& after);

/// The findings of a study that are in one set or in both.
/// @pre the findings of each can be told apart
std::vector<FindingComparison> match_findings(const Pair<ResultRecord>& study);

/// @throws InputError if a study has two findings that cannot be told apart
void require_distinct(const ResultSet& set, const ResultRecord* study);

}  // namespace acstudy
