#include "studies/commands/run/batches.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <utility>

namespace acstudy {

namespace {

/// Cases that share their sums over pairs, by what they share: particles, then pairs.
using Groups = std::map<std::pair<std::string, std::string>, Batch>;

Groups groups_of(std::span<const Plan> plans, std::span<const std::size_t> which) {
  Groups groups;
  for (const std::size_t i : which) {
    Batch& group = groups[{plans[i].particles, plans[i].pairs}];
    group.cases.push_back(i);
    group.work += plans[i].c->estimated_work();
  }
  return groups;
}

/// Puts groups on the same particles together, up to `most` work a batch. Heaviest batch first.
std::vector<Batch> batches_up_to(double most, const Groups& groups) {
  std::vector<Batch> batches;
  const std::string* particles = nullptr;
  for (const auto& [key, group] : groups) {
    const bool joins = particles != nullptr && *particles == key.first && batches.back().work + group.work <= most;
    if (!joins) batches.emplace_back();
    batches.back().cases.insert(batches.back().cases.end(), group.cases.begin(), group.cases.end());
    batches.back().work += group.work;
    particles = &key.first;
  }
  std::stable_sort(batches.begin(), batches.end(), [](const Batch& a, const Batch& b) { return a.work > b.work; });
  return batches;
}

/// The most work that falls to a worker, if whoever is done takes the next batch.
double longest_share(const std::vector<Batch>& batches, int workers) {
  std::vector<double> shares(static_cast<std::size_t>(workers));
  for (const Batch& batch : batches) *std::min_element(shares.begin(), shares.end()) += batch.work;
  return *std::max_element(shares.begin(), shares.end());
}

}  // namespace

std::vector<Batch> batches_up_to(double most, std::span<const Plan> plans, std::span<const std::size_t> which) {
  return batches_up_to(most, groups_of(plans, which));
}

std::vector<Batch> batches_of(std::span<const Plan> plans, int workers) {
  std::vector<std::size_t> all(plans.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const Groups groups = groups_of(plans, all);
  double total = 0.0;
  for (const auto& [key, group] : groups) total += group.work;
  for (const double parts : {1.0, 2.0}) {
    auto batches = batches_up_to(total / (parts * workers), groups);
    if (longest_share(batches, workers) <= 1.03 * total / workers) return batches;
  }
  return batches_up_to(total / (4.0 * workers), groups);
}

}  // namespace acstudy
