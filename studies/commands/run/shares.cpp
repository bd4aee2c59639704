#include "studies/commands/run/shares.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "studies/cases/checksum.hpp"

namespace acstudy {

std::string Shard::suffix() const { return whole() ? "" : fmt::format(".{}-of-{}", number, count); }
std::string Shard::label() const { return fmt::format("{}/{}", number, count); }

namespace {

/// The key that cases have in common which save work together.
std::string group_of(const Case& c) {
  Case plain = c;
  if (plain.scheme.program == nullptr) plain.scheme.nonlocal_divergence = plain.nonlocal_source = false;
  return plain.key();
}

/// What is done in one share.
struct Unit {
  std::uint64_t work = 0;  ///< whole, so that no machine rounds it in another way
  std::string name;        ///< the first of its keys
};

/// The numbers of units, some of which turn out to be one.
class Units {
 public:
  std::size_t add() {
    parents_.push_back(parents_.size());
    return parents_.size() - 1;
  }
  std::size_t find(std::size_t unit) const {
    while (parents_[unit] != unit) unit = parents_[unit];
    return unit;
  }
  void join(std::size_t a, std::size_t b) {
    const auto [first, second] = std::minmax({find(a), find(b)});
    parents_[second] = first;
  }
  std::size_t size() const { return parents_.size(); }

 private:
  std::vector<std::size_t> parents_;
};

}  // namespace

Shares::Shares(const std::vector<Study>& studies, int count) : count_(count) {
  for (std::size_t s = 0; s < studies.size(); ++s) {
    if (!studies[s].series.empty()) continue;
    std::vector<int>& shares = of_measurement_[s];
    shares.resize(studies[s].measurements.size());
    // So that the first share does not get the first of every study.
    const std::uint64_t first = checksum(studies[s].name) % static_cast<std::uint64_t>(count);
    for (std::size_t i = 0; i < shares.size(); ++i) {
      shares[i] = static_cast<int>((first + i) % static_cast<std::uint64_t>(count)) + 1;
    }
  }
  if (count == 1) return;

  Units units;
  std::unordered_map<std::string, std::size_t> unit_of_group;
  std::unordered_map<std::string, std::pair<std::size_t, std::uint64_t>> cases;  // their units and their work
  for (const Study& study : studies) {
    for (const Series& series : study.series) {
      std::size_t of_series = 0;
      for (std::size_t i = 0; i < series.cases.size(); ++i) {
        const Case& c = series.cases[i];
        const auto [group, is_new] = unit_of_group.try_emplace(group_of(c), units.size());
        if (is_new) units.add();
        if (series.until_decided && i > 0) units.join(of_series, group->second);
        of_series = group->second;
        const auto work = i < series.cases_at_first() ? static_cast<std::uint64_t>(c.estimated_work()) : 0;
        auto& known = cases.try_emplace(c.key(), group->second, 0).first->second.second;
        known = std::max(known, work);
      }
    }
  }
  std::vector<Unit> all(units.size());
  for (const auto& [key, one] : cases) {
    Unit& unit = all[units.find(one.first)];
    unit.work += one.second;
    if (unit.name.empty() || key < unit.name) unit.name = key;
  }
  std::vector<std::size_t> heaviest_first(all.size());
  std::iota(heaviest_first.begin(), heaviest_first.end(), std::size_t{0});
  std::sort(heaviest_first.begin(), heaviest_first.end(), [&](std::size_t a, std::size_t b) {
    return all[a].work != all[b].work ? all[a].work > all[b].work : all[a].name < all[b].name;
  });
  std::vector<std::uint64_t> shares(static_cast<std::size_t>(count));
  std::vector<int> share_of(all.size());
  for (const std::size_t unit : heaviest_first) {
    const auto least = std::min_element(shares.begin(), shares.end());
    *least += all[unit].work;
    share_of[unit] = static_cast<int>(least - shares.begin()) + 1;
  }
  for (const auto& [key, one] : cases) of_case_.emplace(key, share_of[units.find(one.first)]);
}

}  // namespace acstudy
