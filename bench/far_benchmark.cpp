/// @file
/// Seconds per particle of a sweep, in the direct and in the far form, over the number of neighbors on a side.
///
///     build/bench/acstudy_far_benchmark
///
/// Both divergence forms at once, velocities of the paper, particles moved by its flow up to t = 1/2.

#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "solver/far/far_sweeps.hpp"
#include "solver/particles.hpp"
#include "solver/vector/sweeps.hpp"

namespace {

using namespace acstudy;

constexpr double period = 2.0 * std::numbers::pi;

/// What sweeps are given, and the arrays behind it.
struct Swept {
  Swept(std::ptrdiff_t N, double delta)
      : x(N), c_hat(N), c(N), b(N), b_prime(N), u(N), flux(N), local_rate(N + 8), nonlocal_rate(N + 8) {
    for (std::ptrdiff_t j = 0; j < N; ++j) {
      const double x_0 = static_cast<double>(j) * period / static_cast<double>(N);
      x[j] = 2.0 * std::atan2(std::sin(0.5 * x_0) * std::exp(0.5), std::cos(0.5 * x_0));
      b[j] = std::sin(x[j]);
      b_prime[j] = std::cos(x[j]);
      c[j] = std::cos(2.0 * x[j]) / 3.0;
      c_hat[j] = c[j] - b[j];
      u[j] = std::cos(x[j]);
      flux[j] = c_hat[j] * u[j];
    }
    x.wrap(N / 2, period);
    for (PeriodicArray* each : {&c_hat, &c, &b, &b_prime, &u, &flux}) each->wrap(N / 2);
    range = {x.at(0), delta, delta * (1.0 + horizon_tie_tolerance), 0, N};
    upwind = {.kernel = {SweepKernel::Form::inverse},
              .c_hat = c_hat.at(0),
              .b_prime = b_prime.at(0),
              .c = c.at(0),
              .b = b.at(0),
              .local = {u.at(0), flux.at(0), local_rate.data()},
              .nonlocal = {u.at(0), flux.at(0), nonlocal_rate.data()}};
  }

  PeriodicArray x, c_hat, c, b, b_prime, u, flux;
  std::vector<double> local_rate, nonlocal_rate;
  SweepRange range;
  UpwindSweep upwind;
};

template <class Sweep>
void measure(benchmark::State& state, double delta, Sweep sweep) {
  Swept swept(state.range(0), delta);
  for (auto _ : state) benchmark::DoNotOptimize(sweep(swept));
  const double particles = static_cast<double>(state.range(0));
  using benchmark::Counter;
  state.counters["per_particle"] = Counter(particles, Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["neighbors"] = delta / period * particles;
}

void direct(benchmark::State& state, double delta) {
  measure(state, delta, [](Swept& swept) { return sweeps().upwind(swept.range, swept.upwind); });
}
void far_form(benchmark::State& state, double delta) {
  far::Memory memory;
  measure(state, delta,
          [&memory](Swept& swept) { return far::far_sweeps().upwind(swept.range, swept.upwind, memory); });
}

constexpr double fixed_horizon = 0.2;
BENCHMARK_CAPTURE(direct, upwind, fixed_horizon)->RangeMultiplier(2)->Range(640, 81920)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(far_form, upwind, fixed_horizon)
    ->RangeMultiplier(2)
    ->Range(640, 81920)
    ->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
