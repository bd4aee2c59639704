#pragma once

/// @file
/// Sweeps whose cost per particle does not grow with the number of neighbors; for horizons of many spacings.

#include <cstddef>
#include <cstdint>

#include "solver/line/far/scratch.hpp"
#include "solver/line/vector/sweeps.hpp"

namespace acstudy::far {

/// What one thread keeps from sweep to sweep. A sweep uses it alone.
struct Memory {
  Scratch outermost, boxes, inner, outer, charges, rows, one_side;
};

/// The far form of the sweeps of one instruction set: the same arguments and results as those of Sweeps, to 1e-12 of
/// the largest rate: 1e-14 as a rule; where a range is many horizons long Model II loses as many units in the last
/// place.
///
/// Numbers depend on where a range begins and ends, by round-off: for the same bits with any number of threads, cut the
/// ranges in a way that does not follow it, such as by range_size(). `begin` need not be a multiple of anything, and
/// nothing is written outside of the range.
struct FarSweeps {
  const char* name;  ///< that of the Sweeps
  std::int64_t (*upwind)(const SweepRange&, const UpwindSweep&, Memory&);
  std::int64_t (*symmetric)(const SweepRange&, const SymmetricSweep&, Memory&);
};

/// Those of the instruction set of sweeps().
const FarSweeps& far_sweeps();

/// True if a sweep has a far form and it is the faster one at a mean of `neighbors` on a side: kernels whose cell
/// moments are polynomials. A symmetric one has it for velocities of few modes, and not on panels.
///
/// The crossover is measured, by bench/sweep_benchmark.cpp.
bool upwind_far_pays(SweepKernel::Form kernel, double neighbors);
/// @param both  of a sweep for both divergences
bool symmetric_far_pays(SweepKernel::Form kernel, double neighbors, bool both);

/// How many particles a range should have: parts of `count` as equal as multiples of eight can be, each of some four
/// windows of `neighbors` on a side, since filling the first window takes as long as to sum a quarter as many, and of
/// 1024 at least.
std::ptrdiff_t range_size(std::ptrdiff_t count, double neighbors);

}  // namespace acstudy::far
