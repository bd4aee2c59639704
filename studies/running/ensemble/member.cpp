#include "studies/running/ensemble/member.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/clones.hpp"

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

/// The largest |u|; NaN if one is not finite.
ACSTUDY_VECTOR_CLONES double largest_of(const double* u, std::ptrdiff_t count) {
  double largest = 0.0, sum = 0.0;
#pragma omp simd reduction(max : largest) reduction(+ : sum)
  for (std::ptrdiff_t j = 0; j < count; ++j) {
    largest = std::abs(u[j]) > largest ? std::abs(u[j]) : largest;
    sum += 0.0 * u[j];
  }
  return largest + sum;
}

/// A later stage, or the estimate of the error, asks for the rate of stage i, which is solved for.
bool asks_for_solved_rate(const Case& c, std::size_t i) {
  return c.integrator->diagonal(i) != 0.0 && (c.step.adaptive() || c.integrator->asks_for_rate(i, i));
}

bool asks_for_solved_rates(const Case& c) {
  for (std::size_t i = 1; i <= c.integrator->stage_count(); ++i) {
    if (asks_for_solved_rate(c, i)) return true;
  }
  return false;
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
      right(asks_for_solved_rates(its_case) ? count : 0),
      no_source(right.size()),
      registers(*its_case.integrator, count),
      largest(team, 0.0),
      error(its_case.step.adaptive() ? count : 0),
      largest_error(team, 0.0) {}

void Member::stage(std::size_t i, double dt, const Piece& piece) {
  const std::ptrdiff_t j = piece.begin;
  const double* const u = values.u.at(j);
  const bool solved = asks_for_solved_rate(c, i - 1);
  const double *const rate = values.rate.data() + j, *const f = (solved ? no_source.data() : source->f()) + j;
  if (const auto kept = registers.rate(i - 1); !kept.empty()) {
    for (std::ptrdiff_t k = 0; k < piece.size(); ++k) kept[j + k] = rate[k] + f[k];
  }
  if (i == 1 && !error.empty()) std::fill_n(error.begin() + j, piece.size(), 0.0);
  if (!solved) estimate(i - 1, dt, f, piece);
  const StageSum sum = registers.sum(i, dt, i == 1 ? u : u_n.at(j), u, j, piece.size());
  largest[piece] = larger(largest[piece], apply_stage(sum, rate, f, &next[j], piece.size()));
}

void Member::estimate(std::size_t k, double dt, const double* f, const Piece& piece) {
  const double d = dt * c.integrator->estimate[k];
  if (error.empty() || d == 0.0) return;
  const std::ptrdiff_t j = piece.begin;
  const double largest_here = add_to_error(d, values.rate.data() + j, f, &error[j], piece.size());
  largest_error[piece] = larger(largest_error[piece], largest_here);
}

void Member::accept(std::size_t i) {
  std::swap(values.u, next);
  if (i == 1 && u_n.size() > 0) std::swap(next, u_n);
}

void Member::add_source(std::size_t i, double scale, const Piece& piece) {
  const auto u = piece.of(values.u.values());
  if (asks_for_solved_rate(c, i)) std::copy(u.begin(), u.end(), right.begin() + piece.begin);
  const double* const f = source->f() + piece.begin;
  for (std::size_t j = 0; j < u.size(); ++j) u[j] += scale * f[j];
}

void Member::finish_solved(std::size_t i, double scale, const Piece& piece) {
  const auto u = piece.of(values.u.values());
  largest[piece] = larger(largest[piece], largest_of(u.data(), piece.size()));
  if (!asks_for_solved_rate(c, i)) return;
  double* const rate = values.rate.data() + piece.begin;
  const double* const before = right.data() + piece.begin;
  for (std::size_t j = 0; j < u.size(); ++j) rate[j] = (u[j] - before[j]) / scale;
  estimate(i, scale / c.integrator->diagonal(i), no_source.data() + piece.begin, piece);
}

}  // namespace acstudy
