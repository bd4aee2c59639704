#include "studies/commands/run/batches.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "studies/running/ensemble/ensemble.hpp"

namespace acstudy {

namespace {

/// Cases that share their sweeps, by what they share: particles, then sweeps.
using BatchesBySweep = std::map<std::pair<std::string, std::string>, Batch>;

BatchesBySweep sweeps_of(std::span<const Case* const> cases, std::span<const std::size_t> which) {
  BatchesBySweep sweeps;
  for (const std::size_t i : which) {
    const Case& c = *cases[i];
    const bool vector = runs_in_vector_form(c);
    Batch& batch = sweeps[vector ? std::pair(ensemble_key(c), sweep_key(c)) : std::pair(c.key(), std::string())];
    batch.cases.push_back(i);
    batch.work += c.estimated_work();
  }
  return sweeps;
}

/// Puts sweeps on the same particles together, up to `most` work a batch. Heaviest batch first.
std::vector<Batch> batches_up_to(double most, const BatchesBySweep& sweeps) {
  std::vector<Batch> batches;
  const std::string* particles = nullptr;
  for (const auto& [key, sweep] : sweeps) {
    const bool joins = particles != nullptr && *particles == key.first && batches.back().work + sweep.work <= most;
    if (!joins) batches.emplace_back();
    batches.back().cases.insert(batches.back().cases.end(), sweep.cases.begin(), sweep.cases.end());
    batches.back().work += sweep.work;
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

std::vector<Batch> batches_up_to(double most, std::span<const Case* const> cases, std::span<const std::size_t> which) {
  return batches_up_to(most, sweeps_of(cases, which));
}

std::vector<Batch> batches_of(std::span<const Case* const> cases, int workers) {
  std::vector<std::size_t> all(cases.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const BatchesBySweep sweeps = sweeps_of(cases, all);
  double total = 0.0;
  for (const auto& [key, sweep] : sweeps) total += sweep.work;
  for (const double parts : {1.0, 2.0}) {
    auto batches = batches_up_to(total / (parts * workers), sweeps);
    if (longest_share(batches, workers) <= 1.03 * total / workers) return batches;
  }
  return batches_up_to(total / (4.0 * workers), sweeps);
}

}  // namespace acstudy
