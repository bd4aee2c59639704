#pragma once

/// @file
/// The tables of refinement paths: levels, the curve delta(h), where particles start, and what is expected.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reports/judging/orders.hpp"
#include "studies/models/arrangement.hpp"
#include "studies/reading/toml_table.hpp"

namespace acstudy {

/// N = [160, 320, ...], coarse to fine.
std::vector<std::int64_t> read_levels(const Table& table);

/// A refinement path: the curve delta(h) and the levels on it.
struct PathChoice {
  std::string name;
  Expression delta;
  std::vector<std::int64_t> N;
  bool until_decided = false;  ///< levels are run one by one until the verdict is decided
  bool nonlocal_source;
  std::optional<Verdict> expect;
  std::optional<double> order;  ///< in place of theory's
  Start start = {};
  Place at_start = {};
  bool against_reference = false;  ///< the last of N is the reference and no level
};
/// What a study can do with a path.
struct PathRules {
  bool solved = true;        ///< false: no solution is known, so errors are against a reference
  bool needs_delta = true;   ///< false: it is h if left out
  bool adds_levels = false;  ///< N may be { from = 40, until = "decided", most = 10240 }
};
PathChoice read_path(const Table& table, const PathRules& rules = {});

/// A verdict that a study may expect of an order.
Verdict read_expected(const Table& table, const toml::node& node);

}  // namespace acstudy
