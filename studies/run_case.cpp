#include "studies/run_case.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "studies/advance.hpp"
#include "studies/control_choice.hpp"
#include "studies/ensemble/ensemble.hpp"

namespace acstudy {

namespace {

template <class Motion>
CaseResult run_once(const Case& c, const std::atomic<bool>& stop) {
  const auto scheme = make_scheme(c.scheme, *c.scene, c.mu);
  const auto source =
      make_source(c.scheme, *c.scene, c.mu, c.nonlocal_source, c.delta, c.source_rule, c.source_refinement);
  return advance<Motion>(c, *scheme, *source, stop);
}

/// A case that cannot be run to its end for a numerical reason; whatever else goes wrong is not its fault and goes up.
CaseResult failed(const std::string& reason) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  CaseResult result;
  result.completed = true;
  result.failure = reason;
  result.error_linf = result.error_l1 = result.error_l2 = none;
  return result;
}

}  // namespace

namespace {

CaseResult run_readable(const Case& c, const std::atomic<bool>& stop) {
  if (c.scene->standing()) return run_once<StandingParticles>(c, stop);
  if (c.scheme.control == misprinted_trajectories) return run_once<MisprintedParticles>(c, stop);
  return run_once<MovingParticles>(c, stop);
}

std::vector<CaseResult> run_together(std::span<const Case* const> cases, int threads, const std::atomic<bool>& stop) {
  std::string failure;
  try {
    if (cases.size() > 1 || runs_in_vector_form(*cases.front())) return run_ensemble(cases, threads, stop);
    return {run_readable(*cases.front(), stop)};
  } catch (const std::domain_error& error) {
    failure = error.what();
  } catch (const std::runtime_error& error) {
    failure = error.what();
  }
  if (cases.size() == 1) return {failed(failure)};
  // One of them failed; it must not take the others along.
  std::vector<CaseResult> results;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    results.push_back(run_together(cases.subspan(i, 1), threads, stop).front());
  }
  return results;
}

}  // namespace

std::vector<CaseResult> run_cases(std::span<const Case* const> cases, const std::atomic<bool>& stop,
                                  std::size_t repeats, int threads) {
  std::vector<std::vector<double>> seconds(cases.size());
  std::vector<CaseResult> results;
  for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
    results = run_together(cases, threads, stop);
    for (std::size_t i = 0; i < results.size(); ++i) {
      if (!results[i].completed) return results;
      seconds[i].push_back(results[i].seconds);
    }
  }
  for (std::size_t i = 0; i < results.size(); ++i) {
    std::sort(seconds[i].begin(), seconds[i].end());
    results[i].repeats = static_cast<std::int64_t>(repeats);
    results[i].seconds = 0.5 * (seconds[i][(repeats - 1) / 2] + seconds[i][repeats / 2]);
    results[i].seconds_low = seconds[i].front();
    results[i].seconds_high = seconds[i].back();
  }
  return results;
}

CaseResult run_case(const Case& c, const std::atomic<bool>& stop, std::size_t repeats, int threads) {
  const Case* const one = &c;
  return run_cases({&one, 1}, stop, repeats, threads).front();
}

}  // namespace acstudy
