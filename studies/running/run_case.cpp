#include "studies/running/run_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <numeric>
#include <stdexcept>

#include "studies/models/control_choice.hpp"
#include "studies/running/advance.hpp"
#include "studies/running/ensemble/ensemble.hpp"
#include "studies/running/program/run_program.hpp"

namespace acstudy {

namespace {

template <class Motion>
CaseResult run_once(const Case& c, const std::atomic<bool>& stop) {
  const auto scheme = make_scheme(c.scheme, *c.scene, c.mu);
  if (scheme->rows() == nullptr && (c.integrator->implicit() || c.step.bound == StepRule::Bound::rows)) {
    throw std::domain_error(
        "neither a limiter nor a control with sums of its own knows its rows: no implicit step, no bound");
  }
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
  if (c.scheme.control != nullptr && c.scheme.control->flow != nullptr) return run_once<MisprintedParticles>(c, stop);
  return run_once<MovingParticles>(c, stop);
}

std::vector<CaseResult> run_together(std::span<const Plan> plans, int threads, const std::atomic<bool>& stop,
                                     double most_seconds) {
  std::string failure;
  try {
    if (plans.front().form->together) return run_ensemble(plans, threads, stop, most_seconds);
    const Case& c = *plans.front().c;
    return {c.scheme.program != nullptr ? run_program(c, stop) : run_readable(c, stop)};
  } catch (const std::bad_alloc&) {
    const Case& c = *plans.front().c;
    failure = fmt::format("{}N = {}, about {:.0f} MB", over_memory, c.N, 1e-6 * (c.working_bytes() + c.result_bytes()));
  } catch (const std::domain_error& error) {
    failure = error.what();
  } catch (const std::runtime_error& error) {
    failure = error.what();
  }
  if (plans.size() == 1) return {failed(failure)};
  // One of them failed; it must not take the others along.
  std::vector<CaseResult> results;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    results.push_back(run_together(plans.subspan(i, 1), threads, stop, most_seconds).front());
  }
  return results;
}

}  // namespace

std::vector<CaseResult> run_cases(std::span<const Plan> plans, const std::atomic<bool>& stop, std::size_t repeats,
                                  int threads, double most_seconds) {
  std::vector<CaseResult> results(plans.size());
  std::vector<std::vector<double>> seconds(plans.size());
  std::vector<std::size_t> which(plans.size());
  std::iota(which.begin(), which.end(), std::size_t{0});
  for (std::size_t repeat = 0; repeat < repeats && !which.empty(); ++repeat) {
    std::vector<Plan> these;
    for (const std::size_t i : which) these.push_back(plans[i]);
    std::vector<CaseResult> once = run_together(these, threads, stop, most_seconds);
    for (std::size_t k = 0; k < which.size(); ++k) {
      results[which[k]] = std::move(once[k]);
      seconds[which[k]].push_back(results[which[k]].seconds);
    }
    // A case that is not run to its end lacks a repeat and counts as not run.
    std::erase_if(which, [&](std::size_t i) { return !results[i].completed; });
  }
  for (const std::size_t i : which) {
    std::sort(seconds[i].begin(), seconds[i].end());
    results[i].repeats = static_cast<std::int64_t>(repeats);
    results[i].seconds = 0.5 * (seconds[i][(repeats - 1) / 2] + seconds[i][repeats / 2]);
    results[i].seconds_low = seconds[i].front();
    results[i].seconds_high = seconds[i].back();
  }
  return results;
}

CaseResult run_case(const Case& c, const std::atomic<bool>& stop, std::size_t repeats, int threads) {
  const Plan one = plan(c);
  return run_cases({&one, 1}, stop, repeats, threads).front();
}

}  // namespace acstudy
