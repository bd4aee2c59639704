#include "studies/ensemble/shared_particles.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "solver/vector/clones.hpp"
#include "studies/stopwatch.hpp"

namespace acstudy {

namespace {

/// Longer series cost more than the expressions that they stand for.
constexpr std::size_t most_series_modes = 16;

/// The smallest x[j + 1] - x[j]; NaN if one is.
ACSTUDY_VECTOR_CLONES double smallest_gap_of(const double* x, std::ptrdiff_t count) {
  double smallest = x[1] - x[0], sum = 0.0;
#pragma omp simd reduction(min : smallest) reduction(+ : sum)
  for (std::ptrdiff_t j = 0; j < count; ++j) {
    const double gap = x[j + 1] - x[j];
    smallest = gap < smallest ? gap : smallest;
    sum += 0.0 * gap;  // NaN if the gap is, which the comparison passes over
  }
  return smallest + sum;
}

/// e^{i n w x/2} from e^{i w x/2}, by its real and imaginary part.
void powers_of_phases(const double* cosine, const double* sine, std::ptrdiff_t count, int n, double* power_cosine,
                      double* power_sine) {
  std::copy_n(cosine, count, power_cosine);
  std::copy_n(sine, count, power_sine);
  for (int power = 1; power < n; ++power) {
    for (std::ptrdiff_t j = 0; j < count; ++j) {
      const double real = power_cosine[j] * cosine[j] - power_sine[j] * sine[j];
      power_sine[j] = power_sine[j] * cosine[j] + power_cosine[j] * sine[j];
      power_cosine[j] = real;
    }
  }
}

}  // namespace

double midpoint_reach(double delta, double largest_gap) {
  return 0.625 * (std::max(delta, largest_gap) + sweeps().lanes * largest_gap);
}

VelocitySeries::VelocitySeries(const Scene& scene) {
  const auto series = [&](const Field& field) {
    return trigonometric_series(field, scene.period(), most_series_modes);
  };
  c = series([&](auto x, auto out) { scene.c(x, out); });
  if (scene.standing()) return;
  b = series([&](auto x, auto out) { scene.b(x, out); });
  b_prime = series([&](auto x, auto out) { scene.b_prime(x, out); });
}

std::optional<MidpointModes> midpoint_modes(const VelocitySeries& velocity) {
  if (!velocity.c || !velocity.b) return std::nullopt;
  MidpointModes modes;
  for (auto [series, field] : {std::pair(&*velocity.c, &modes.c), std::pair(&*velocity.b, &modes.b)}) {
    field->constant = series->constant;
    for (std::size_t i = 0; i < series->highest(); ++i) {
      if (series->cosine[i] == 0.0 && series->sine[i] == 0.0) continue;
      const int n = static_cast<int>(i) + 1;
      const auto mode = std::find(modes.number.begin(), modes.number.end(), n) - modes.number.begin();
      if (mode == most_modes) return std::nullopt;
      if (mode == std::ssize(modes.number)) modes.number.push_back(n);
      field->mode[field->modes] = static_cast<int>(mode);
      field->cosine[field->modes] = series->cosine[i];
      field->sine[field->modes] = series->sine[i];
      ++field->modes;
    }
  }
  return modes;
}

SharedParticles::SharedParticles(const Scene& scene, std::vector<double> start, Needs needs, Team& team)
    : x(start.size()),
      scene_(scene),
      needs_(needs),
      team_(team),
      series_(scene),
      start_(std::move(start)),
      wrapped_(std::min<std::ptrdiff_t>(32, x.margin())) {
  if (!scene.standing()) trajectories_.emplace(scene, start_);
  const std::size_t count = start_.size();
  if (needs.midpoints) {
    modes = midpoint_modes(series_);
    if (modes) mode_cosine.assign(modes->number.size(), PeriodicArray(count));
    mode_sine = mode_cosine;
  }
  if (needs.velocities) {
    for (PeriodicArray* field : {&c, &b, &c_hat}) *field = PeriodicArray(count);
  }
  if (needs.b_prime) b_prime = PeriodicArray(count);
  const bool by_series = (needs.velocities && (series_.c || series_.b)) || (needs.b_prime && series_.b_prime);
  needs_.phases = needs.phases || modes || by_series;
  if (needs_.phases) {
    half_cosine_ = PeriodicArray(count);
    half_sine_ = PeriodicArray(count);
  }
}

std::span<const double> SharedParticles::positions(double t) {
  return trajectories_ ? trajectories_->at(t) : std::span<const double>(start_);
}

void SharedParticles::move(double t) {
  if (t == t_ || (t_ >= 0.0 && !trajectories_)) return;
  const bool each_alone = trajectories_ && trajectories_->closed_form() && t != 0.0;
  timed(positions_seconds, [&] {
    if (each_alone) {
      team_.each(std::ssize(x), 64, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        trajectories_->at(t, begin, x.values().subspan(begin, end - begin));
      });
    } else {
      const auto now = positions(t);
      std::copy(now.begin(), now.end(), x.values().begin());
    }
    wrap_positions();
    const double smallest = smallest_gap_of(x.at(0), std::ssize(x));
    if (needs_.midpoints && !modes) fit_panels();
    // not (smallest <= 0), so that NaN is refused
    if (!(smallest > 0.0)) {
      throw std::domain_error("particles have crossed: positions no longer increase within one period");
    }
    smallest_gap_ = smallest;
  });
  timed(velocities_seconds, [&] {
    team_.each(std::ssize(x), 64, [&](std::ptrdiff_t begin, std::ptrdiff_t end) { fill(begin, end); });
    wrap_fields();
  });
  t_ = t;
  ++times_moved_;
}

void SharedParticles::fill(std::ptrdiff_t begin, std::ptrdiff_t end) {
  const auto part = [&](PeriodicArray& field) { return field.values().subspan(begin, end - begin); };
  if (needs_.phases) half_phases(part(x), scene_.period(), part(half_cosine_), part(half_sine_));
  const auto evaluate = [&](const std::optional<TrigonometricSeries>& series, PeriodicArray& field, auto&& directly) {
    if (series) {
      series->evaluate({part(half_cosine_), part(half_sine_)}, part(field));
    } else {
      directly(part(x), part(field));
    }
  };
  if (needs_.velocities) {
    evaluate(series_.c, c, [&](auto at, auto out) { scene_.c(at, out); });
    if (!scene_.standing()) evaluate(series_.b, b, [&](auto at, auto out) { scene_.b(at, out); });
    for (std::ptrdiff_t j = begin; j < end; ++j) c_hat[j] = c[j] - b[j];
  }
  if (needs_.b_prime) evaluate(series_.b_prime, b_prime, [&](auto at, auto out) { scene_.b_prime(at, out); });
  if (!modes) return;
  for (std::size_t k = 0; k < modes->number.size(); ++k) {
    powers_of_phases(half_cosine_.at(begin), half_sine_.at(begin), end - begin, modes->number[k],
                     &mode_cosine[k][begin], &mode_sine[k][begin]);
  }
}

void SharedParticles::wrap_positions() {
  // As far as the windows reached so far; if they have grown, twice as far.
  for (;; wrapped_ = std::min(2 * wrapped_, x.margin())) {
    x.wrap(wrapped_, scene_.period());
    if (wrapped_ == x.margin() || reach(needs_.delta) < wrapped_) return;
  }
}

void SharedParticles::fit_panels() {
  double largest = 0.0;
  for (std::ptrdiff_t j = 0; j < std::ssize(x); ++j) largest = std::max(largest, x[j + 1] - x[j]);
  const double reach = midpoint_reach(needs_.delta, largest);
  if (panels && reach <= 1.25 * panels->reach()) return;
  panels = VelocityPanels::find(scene_, reach);
  if (!panels) {
    throw std::runtime_error(
        "the velocities vary too fast between particles and their neighbors for the vector form; use --form readable");
  }
}

void SharedParticles::wrap_fields() {
  const std::ptrdiff_t reach = this->reach(needs_.delta), lanes = sweeps().lanes;
  if (needs_.velocities) {
    b.wrap(reach);
    // What a particle needs of itself alone is read up to the end of a vector.
    c.wrap(lanes);
    c_hat.wrap(lanes);
  }
  if (needs_.b_prime) b_prime.wrap(lanes);
  for (std::size_t k = 0; k < mode_cosine.size(); ++k) {
    for (PeriodicArray* field : {&mode_cosine[k], &mode_sine[k]}) {
      modes->number[k] % 2 == 0 ? field->wrap(reach) : field->wrap_alternating(reach);
    }
  }
}

double SharedParticles::place_of_smallest_gap() const {
  std::ptrdiff_t j = 0;
  while (x[j + 1] - x[j] != smallest_gap_) ++j;
  return x[j];
}

std::ptrdiff_t SharedParticles::reach(double delta) const {
  const double inside = this->inside(delta);
  // A vector of particles may begin at the last one, and every walk looks at one neighbor beyond its window.
  const std::ptrdiff_t n = std::ssize(x), last = n + sweeps().lanes;
  std::ptrdiff_t right = last, left = 0;
  while (right + 2 < n + wrapped_ && x[right] - x[last] <= inside) ++right;
  while (left - 2 > -wrapped_ && x[0] - x[left] <= inside) --left;
  return std::max(right + 2 - n, 2 - left);
}

}  // namespace acstudy
