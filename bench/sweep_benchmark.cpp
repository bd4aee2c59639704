/// @file
/// Pair rates and seconds per particle of the sweeps: direct and far form of Model I, Model II, and the banded product
/// of particles that stand still.
///
///     build/bench/acstudy_sweep_benchmark
///
/// Both divergence forms at once, velocities of the paper, particles moved by its flow up to t = 1/2.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "solver/line/far/far_sweeps.hpp"
#include "solver/line/particles.hpp"
#include "solver/line/vector/sweeps.hpp"

namespace {

using namespace acstudy;

constexpr double period = 2.0 * std::numbers::pi;

/// What sweeps are given, and the arrays behind it.
struct Swept {
  Swept(std::ptrdiff_t N, double delta)
      : x(N),
        c_hat(N),
        c(N),
        b(N),
        b_prime(N),
        u(N),
        flux(N),
        half_cosine(N),
        half_sine(N),
        cosine(N),
        local_rate(N + 8),
        nonlocal_rate(N + 8) {
    for (std::ptrdiff_t j = 0; j < N; ++j) {
      const double x_0 = static_cast<double>(j) * period / static_cast<double>(N);
      x[j] = 2.0 * std::atan2(std::sin(0.5 * x_0) * std::exp(0.5), std::cos(0.5 * x_0));
      b[j] = std::sin(x[j]);
      b_prime[j] = std::cos(x[j]);
      c[j] = std::cos(2.0 * x[j]) / 3.0;
      c_hat[j] = c[j] - b[j];
      u[j] = std::cos(x[j]);
      flux[j] = c_hat[j] * u[j];
      half_cosine[j] = std::cos(0.5 * x[j]);
      half_sine[j] = std::sin(0.5 * x[j]);
      cosine[j] = std::cos(x[j]);
    }
    x.wrap(N / 2, period);
    for (PeriodicArray* each : {&c_hat, &c, &b, &b_prime, &u, &flux, &cosine}) each->wrap(N / 2);
    for (PeriodicArray* each : {&half_cosine, &half_sine}) each->wrap_alternating(N / 2);
    range = {x.at(0), delta, delta * (1.0 + horizon_tie_tolerance), 0, N};
    upwind = {.kernel = {SweepKernel::Form::inverse},
              .c_hat = c_hat.at(0),
              .b_prime = b_prime.at(0),
              .c = c.at(0),
              .b = b.at(0),
              .local = {u.at(0), flux.at(0), local_rate.data()},
              .nonlocal = {u.at(0), flux.at(0), nonlocal_rate.data()}};
  }

  /// Model II with the same particles: c = cos(2 x)/3, b = sin(x).
  SymmetricSweep symmetric(bool with_nonlocal) {
    SymmetricSweep sweep{.kernel = {SweepKernel::Form::cubic_spline},
                         .mu = 4.0 / 3.0,
                         .x = x.at(0),
                         .panels = {},
                         .half_cosine = {half_cosine.at(0), cosine.at(0), x.at(0), x.at(0)},
                         .half_sine = {half_sine.at(0), b.at(0), x.at(0), x.at(0)},
                         .c = {.modes = 1, .mode = {1}, .cosine = {1.0 / 3.0}},
                         .b = {.modes = 1, .mode = {0}, .sine = {1.0}},
                         .b_prime = b_prime.at(0),
                         .local = {u.at(0), nullptr, local_rate.data()},
                         .nonlocal = {}};
    if (with_nonlocal) sweep.nonlocal = {u.at(0), nullptr, nonlocal_rate.data()};
    return sweep;
  }

  PeriodicArray x, c_hat, c, b, b_prime, u, flux, half_cosine, half_sine, cosine;
  std::vector<double> local_rate, nonlocal_rate;
  SweepRange range;
  UpwindSweep upwind;
};

/// Seconds per particle with the horizon 0.2.
template <class Sweep>
void per_particle(benchmark::State& state, Sweep sweep) {
  constexpr double delta = 0.2;
  Swept swept(state.range(0), delta);
  far::Memory memory;
  for (auto _ : state) benchmark::DoNotOptimize(sweep(swept, memory));
  const double particles = static_cast<double>(state.range(0));
  using benchmark::Counter;
  state.counters["per_particle"] = Counter(particles, Counter::kIsIterationInvariantRate | Counter::kInvert);
  state.counters["neighbors"] = delta / period * particles;
}

/// A far sweep, in ranges as the solver cuts them.
template <class Far, class Sweep>
std::int64_t in_ranges(Far far_sweep, SweepRange range, const Sweep& sweep, far::Memory& memory) {
  const std::ptrdiff_t size = far::range_size(range.end, range.delta / period * static_cast<double>(range.end));
  std::int64_t pairs = 0;
  for (const std::ptrdiff_t end = range.end; range.begin < end; range.begin = range.end) {
    range.end = std::min(range.begin + size, end);
    pairs += far_sweep(range, sweep, memory);
  }
  return pairs;
}

/// Both divergence forms of Model I, or the nonlocal one.
void upwind(benchmark::State& state, SweepKernel::Form kernel, bool both, bool far_form) {
  per_particle(state, [&](Swept& swept, far::Memory& memory) {
    swept.upwind.kernel.form = kernel;
    if (!both) swept.upwind.local = {};
    return far_form ? in_ranges(far::far_sweeps().upwind, swept.range, swept.upwind, memory)
                    : sweeps().upwind(swept.range, swept.upwind);
  });
}

/// Both divergence forms of Model II, or the local one.
void symmetric(benchmark::State& state, bool both, bool far_form) {
  per_particle(state, [&](Swept& swept, far::Memory& memory) {
    const SymmetricSweep sweep = swept.symmetric(both);
    return far_form ? in_ranges(far::far_sweeps().symmetric, swept.range, sweep, memory)
                    : sweeps().symmetric(swept.range, sweep);
  });
}

void resolutions(benchmark::internal::Benchmark* benchmark) {
  for (int N = 1280; N <= 81920; N *= 2) benchmark->Arg(N);
  benchmark->Unit(benchmark::kMicrosecond);
}

/// Pairs per second, each counted once for each scheme whose rate it goes into. range(1) is the horizon in tenths of
/// the spacing; 0 stands for delta = 0.2.
template <class Sweep>
void pair_rate(benchmark::State& state, int schemes, Sweep sweep) {
  const double spacings = 0.1 * static_cast<double>(state.range(1));
  Swept swept(state.range(0), spacings == 0.0 ? 0.2 : spacings * period / static_cast<double>(state.range(0)));
  double pairs = 0.0;
  for (auto _ : state) pairs += static_cast<double>(schemes * sweep(swept));
  state.counters["pairs"] = benchmark::Counter(pairs, benchmark::Counter::kIsRate);
}

void pairs_upwind(benchmark::State& state, SweepKernel::Form form, bool both) {
  pair_rate(state, both ? 2 : 1, [=](Swept& swept) {
    UpwindSweep sweep = swept.upwind;
    sweep.kernel.form = form;
    if (!both) sweep.nonlocal = {};
    return sweeps().upwind(swept.range, sweep);
  });
}
void pairs_symmetric(benchmark::State& state, bool both) {
  pair_rate(state, both ? 2 : 1, [=](Swept& swept) { return sweeps().symmetric(swept.range, swept.symmetric(both)); });
}

/// Rows of as many entries each as range(1).
void pairs_banded(benchmark::State& state) {
  const std::ptrdiff_t N = state.range(0), width = state.range(1);
  RateMatrix R;
  for (std::ptrdiff_t j = 0; j < N; ++j) {
    for (std::ptrdiff_t k = 0; k < width; ++k) R.add(j - k, N, 1.0 / static_cast<double>(k + 1));
    R.end_row();
  }
  const BandedMatrix banded(R, sweeps().lanes);
  PeriodicArray u(static_cast<std::size_t>(N));
  for (std::ptrdiff_t j = 0; j < N; ++j) u[j] = std::cos(static_cast<double>(j));
  u.wrap(banded.reach);
  std::vector<double> rate(N + 8);
  double pairs = 0.0;
  for (auto _ : state) {
    sweeps().banded(banded.blocks.data(), banded.value.data(), u.at(0), rate.data(), 0, std::ssize(banded.blocks));
    benchmark::DoNotOptimize(rate.data());
    pairs += static_cast<double>(N * width);
  }
  state.counters["pairs"] = benchmark::Counter(pairs, benchmark::Counter::kIsRate);
}

/// Of the paper's paths: delta = 0.2, sqrt(h) at N = 2560, 4h, and h^2, within which only the nearest is a neighbor.
void windows(benchmark::internal::Benchmark* benchmark) {
  for (const int N : {2560, 20480}) benchmark->Args({N, 0});
  for (const int tenths : {200, 40, 1}) benchmark->Args({2560, tenths});
}
BENCHMARK_CAPTURE(pairs_upwind, inverse, SweepKernel::Form::inverse, false)->Apply(windows);
BENCHMARK_CAPTURE(pairs_upwind, inverse_both, SweepKernel::Form::inverse, true)->Apply(windows);
BENCHMARK_CAPTURE(pairs_upwind, spline, SweepKernel::Form::cubic_spline, false)->Apply(windows);
BENCHMARK_CAPTURE(pairs_upwind, spline_both, SweepKernel::Form::cubic_spline, true)->Apply(windows);
BENCHMARK_CAPTURE(pairs_symmetric, spline, false)->Apply(windows);
BENCHMARK_CAPTURE(pairs_symmetric, spline_both, true)->Apply(windows);
BENCHMARK(pairs_banded)->Args({1280, 42})->Args({20480, 42})->Args({20480, 653});

constexpr double fixed_horizon = 0.2;
BENCHMARK_CAPTURE(upwind, inverse_both_direct, SweepKernel::Form::inverse, true, false)->Apply(resolutions);
BENCHMARK_CAPTURE(upwind, inverse_both_far, SweepKernel::Form::inverse, true, true)->Apply(resolutions);
BENCHMARK_CAPTURE(upwind, inverse_direct, SweepKernel::Form::inverse, false, false)->Apply(resolutions);
BENCHMARK_CAPTURE(upwind, inverse_far, SweepKernel::Form::inverse, false, true)->Apply(resolutions);
BENCHMARK_CAPTURE(upwind, spline_both_direct, SweepKernel::Form::cubic_spline, true, false)->Apply(resolutions);
BENCHMARK_CAPTURE(upwind, spline_both_far, SweepKernel::Form::cubic_spline, true, true)->Apply(resolutions);
BENCHMARK_CAPTURE(upwind, spline_direct, SweepKernel::Form::cubic_spline, false, false)->Apply(resolutions);
BENCHMARK_CAPTURE(upwind, spline_far, SweepKernel::Form::cubic_spline, false, true)->Apply(resolutions);
BENCHMARK_CAPTURE(symmetric, spline_both_direct, true, false)->Apply(resolutions);
BENCHMARK_CAPTURE(symmetric, spline_both_far, true, true)->Apply(resolutions);
BENCHMARK_CAPTURE(symmetric, spline_direct, false, false)->Apply(resolutions);
BENCHMARK_CAPTURE(symmetric, spline_far, false, true)->Apply(resolutions);

}  // namespace

BENCHMARK_MAIN();
