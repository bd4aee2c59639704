#pragma once

/// @file
/// The estimates of a judgement by name.

#include <string>
#include <utility>
#include <vector>

#include "reports/judging/orders.hpp"

namespace acstudy {

/// The estimates by the names that both result files give them, after "observed_" in the one. Levels count from 1.
std::vector<std::pair<std::string, double>> named_estimates(const Judgement& judgement);

}  // namespace acstudy
