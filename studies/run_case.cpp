#include "studies/run_case.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "solver/model1.hpp"
#include "solver/model2.hpp"
#include "studies/advance.hpp"

namespace acstudy {

namespace {

std::unique_ptr<Source> make_source(const Case& c, KernelProfile kernel) {
  if (!c.nonlocal_source) return local_source(*c.scene);
  return nonlocal_source(*c.scene, {c.scheme.model, c.scheme.nonlocal_divergence, std::move(kernel), c.delta, c.mu},
                         c.source_rule);
}

template <class Motion, class Divergence, class K>
CaseResult run_scheme(const Case& c, const K& kernel, const std::atomic<bool>& stop) {
  const auto source = make_source(c, profile(kernel));
  if (c.scheme.model == 1) return advance<Motion>(c, ModelI<K, Divergence>(kernel), *source, stop);
  if constexpr (IntegrableKernel<K>) {
    return advance<Motion>(c, ModelII<K, Divergence>(kernel, c.mu), *source, stop);
  } else {
    throw std::logic_error("Model II with a kernel that is not integrable");
  }
}

template <class K>
CaseResult run_kernel(const Case& c, const K& kernel, const std::atomic<bool>& stop) {
  if (c.scene->standing()) return run_scheme<StandingParticles, NoDivergence>(c, kernel, stop);
  if (c.scheme.nonlocal_divergence) return run_scheme<MovingParticles, NonlocalDivergence>(c, kernel, stop);
  return run_scheme<MovingParticles, LocalDivergence>(c, kernel, stop);
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

CaseResult run_case(const Case& c, const std::atomic<bool>& stop, std::size_t least_repeats) {
  constexpr std::size_t most_repeats = 5;
  constexpr double enough_seconds = 0.1;

  std::vector<double> seconds, source_seconds;
  CaseResult result;
  double total = 0.0;
  do {
    try {
      result = with_kernel(c.scheme.kernel, [&](const auto& kernel) { return run_kernel(c, kernel, stop); });
    } catch (const std::domain_error& error) {
      result = failed(error.what());
    } catch (const std::runtime_error& error) {
      result = failed(error.what());
    }
    if (!result.completed) return result;
    seconds.push_back(result.seconds);
    source_seconds.push_back(result.source_seconds);
    total += result.seconds;
  } while (std::isfinite(result.error_linf) &&
           (seconds.size() < least_repeats || (seconds.size() < most_repeats && total < enough_seconds)));

  const auto median = [](std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
  };
  result.repeats = static_cast<std::int64_t>(seconds.size());
  result.seconds = median(seconds);
  result.source_seconds = median(source_seconds);
  result.seconds_low = *std::min_element(seconds.begin(), seconds.end());
  result.seconds_high = *std::max_element(seconds.begin(), seconds.end());
  return result;
}

}  // namespace acstudy
