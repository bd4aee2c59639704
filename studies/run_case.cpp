#include "studies/run_case.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "studies/advance.hpp"
#include "studies/control_choice.hpp"

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

Errors errors_of(const Scene& scene, std::span<const double> x, std::span<const double> u,
                 std::span<const double> u_exact) {
  const std::size_t count = x.size();
  Errors errors;
  for (std::size_t j = 0; j < count; ++j) {
    const double right = j + 1 < count ? x[j + 1] : x[0] + scene.period();
    const double left = j > 0 ? x[j - 1] : x[count - 1] - scene.period();
    const double error = std::abs(u[j] - u_exact[j]), width = 0.5 * (right - left);
    // Once NaN, it stays: no comparison with a NaN is true.
    if (std::isnan(error) || error > errors.linf) errors.linf = error;
    errors.l1 += width * error;
    errors.l2 = std::hypot(errors.l2, std::sqrt(width) * error);  // a square of an error may overflow
  }
  errors.l1 /= scene.period();
  errors.l2 /= std::sqrt(scene.period());
  return errors;
}

CaseResult run_case(const Case& c, const std::atomic<bool>& stop, std::size_t least_repeats, bool timed) {
  const std::size_t most_repeats = timed ? 5 : 1;
  constexpr double enough_seconds = 0.1;

  std::vector<double> seconds;
  CaseResult result;
  double total = 0.0;
  do {
    try {
      result = c.scene->standing()                           ? run_once<StandingParticles>(c, stop)
               : c.scheme.control == misprinted_trajectories ? run_once<MisprintedParticles>(c, stop)
                                                             : run_once<MovingParticles>(c, stop);
    } catch (const std::domain_error& error) {
      result = failed(error.what());
    } catch (const std::runtime_error& error) {
      result = failed(error.what());
    }
    if (!result.completed) return result;
    seconds.push_back(result.seconds);
    total += result.seconds;
  } while (std::isfinite(result.error_linf) &&
           (seconds.size() < least_repeats || (seconds.size() < most_repeats && total < enough_seconds)));

  const auto median = [](std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
  };
  result.repeats = static_cast<std::int64_t>(seconds.size());
  result.seconds = median(seconds);
  result.seconds_low = *std::min_element(seconds.begin(), seconds.end());
  result.seconds_high = *std::max_element(seconds.begin(), seconds.end());
  return result;
}

}  // namespace acstudy
