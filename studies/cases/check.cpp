#include "studies/cases/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace acstudy {

std::string_view name_of(Test test) {
  switch (test) {
    case Test::order:
      return "order";
    case Test::rate:
      return "rate";
    case Test::bounds:
      return "bounds";
    case Test::surface:
      return "surface";
  }
  return "";
}

std::optional<Test> test_from(std::string_view name) {
  for (const Test test : {Test::order, Test::rate, Test::bounds, Test::surface}) {
    if (name_of(test) == name) return test;
  }
  return std::nullopt;
}

Coordinate unspoken(Coordinate coordinate) {
  coordinate.spoken = false;
  return coordinate;
}

Coordinate at_cfl(double cfl) { return {"cfl", cfl, fmt::format("CFL {:g}", cfl)}; }
Coordinate at_horizon(double delta) { return {"delta", delta, fmt::format("delta = {:g}", delta)}; }
Coordinate at_ratio(double delta_over_h) {
  return {"delta/h", delta_over_h, fmt::format("delta = {:g}h", delta_over_h)};
}

std::string Check::conditions() const {
  std::string text;
  for (const Coordinate& one : coordinates) {
    if (one.spoken) text += (text.empty() ? "" : ", ") + one.words;
  }
  return text;
}

void Check::be_control(const std::string& why, Verdict verdict) {
  expected = verdict;
  remark = "negative control: " + why;
}

namespace {

/// What a check has at a coordinate; nothing where it has none of that name.
const Coordinate::Value* value_at(const Check& check, const std::string& name) {
  const auto found = std::find_if(check.coordinates.begin(), check.coordinates.end(),
                                  [&](const Coordinate& one) { return one.name == name; });
  return found == check.coordinates.end() ? nullptr : &found->value;
}

bool differ_at(const std::string& name, const std::vector<Check*>& checks) {
  const Coordinate::Value* const first = value_at(*checks.front(), name);
  return std::any_of(checks.begin(), checks.end(), [&](const Check* check) {
    const Coordinate::Value* const value = value_at(*check, name);
    return (value == nullptr) != (first == nullptr) || (value != nullptr && *value != *first);
  });
}

using ByName = std::map<std::string, std::vector<Check*>>;

ByName by_name(const std::vector<Check*>& checks) {
  ByName names;
  for (Check* const check : checks) names[check->label()].push_back(check);
  return names;
}

}  // namespace

std::string tell_apart(const std::vector<Check*>& checks) {
  for (const auto& [name, same] : by_name(checks)) {
    for (Check* const check : same) {
      for (Coordinate& one : check->coordinates) one.spoken = one.spoken || differ_at(one.name, same);
    }
  }
  for (const auto& [name, same] : by_name(checks)) {
    if (same.size() > 1) return name;
  }
  return {};
}

}  // namespace acstudy
