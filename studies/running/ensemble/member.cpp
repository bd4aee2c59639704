#include "studies/running/ensemble/member.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/line/vector/clones.hpp"

namespace acstudy {

namespace {

/// next = the sum of a stage at some particles, where the newest rate is rate + f.
/// @return  the largest |next|; NaN if one is not finite
ACSTUDY_VECTOR_CLONES double apply_stage(const StageSum stage, const double* rate, const double* f, double* next,
                                         std::ptrdiff_t count) {
  double largest = 0.0, sum = 0.0;
#pragma omp simd reduction(max : largest) reduction(+ : sum)
  for (std::ptrdiff_t j = 0; j < count; ++j) {
    const double value = stage(j, rate[j] + f[j]);
    next[j] = value;
    largest = std::abs(value) > largest ? std::abs(value) : largest;
    sum += 0.0 * value;  // NaN if the value is not finite, which the comparison passes over
  }
  return largest + sum;
}

/// error += d (rate + f) at some particles.
/// @return  the largest |error|; NaN if one is not finite
ACSTUDY_VECTOR_CLONES double add_to_error(double d, const double* rate, const double* f, double* error,
                                          std::ptrdiff_t count) {
  double largest = 0.0, sum = 0.0;
#pragma omp simd reduction(max : largest) reduction(+ : sum)
  for (std::ptrdiff_t j = 0; j < count; ++j) {
    const double value = error[j] + d * (rate[j] + f[j]);
    error[j] = value;
    largest = std::abs(value) > largest ? std::abs(value) : largest;
    sum += 0.0 * value;
  }
  return largest + sum;
}

}  // namespace

Member::Member(const Case& its_case, std::size_t count, const Team& team)
    : c(its_case),
      values{PeriodicArray(count),
             PeriodicArray(
                 its_case.scheme.model->vector_form == VectorForm::upwind && !its_case.scene->standing() ? count : 0),
             ZeroedVector(count + 16)},
      next(count),
      u_n(its_case.integrator->stage_count() > 1 ? count : 0),
      registers(*its_case.integrator, count),
      largest(team, 0.0),
      error(its_case.step.adaptive() ? count : 0),
      largest_error(team, 0.0) {}

void Member::stage(std::size_t i, double dt, const Piece& piece) {
  const std::ptrdiff_t j = piece.begin;
  const double* const u = values.u.at(j);
  const double *const rate = values.rate.data() + j, *const f = source->f() + j;
  if (const auto kept = registers.rate(i - 1); !kept.empty()) {
    for (std::ptrdiff_t k = 0; k < piece.size(); ++k) kept[j + k] = rate[k] + f[k];
  }
  if (!error.empty()) {
    if (i == 1) std::fill_n(error.begin() + j, piece.size(), 0.0);
    const double d = dt * c.integrator->estimate[i - 1];
    largest_error[piece] = larger(largest_error[piece], add_to_error(d, rate, f, &error[j], piece.size()));
  }
  const StageSum sum = registers.sum(i, dt, i == 1 ? u : u_n.at(j), u, j, piece.size());
  largest[piece] = larger(largest[piece], apply_stage(sum, rate, f, &next[j], piece.size()));
}

void Member::accept(std::size_t i) {
  std::swap(values.u, next);
  if (i == 1 && u_n.size() > 0) std::swap(next, u_n);
}

}  // namespace acstudy
