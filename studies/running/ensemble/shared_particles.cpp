#include "studies/running/ensemble/shared_particles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "solver/clones.hpp"

namespace acstudy {

namespace {

/// Pieces of particles begin at a multiple of this: whole vectors, whatever their width.
constexpr std::ptrdiff_t grain = 32;

/// Longer series cost more than the expressions that they stand for.
constexpr std::size_t most_series_modes = 16;

/// The smallest of `count` gaps x[j + 1] - x[j]; NaN if one is.
ACSTUDY_VECTOR_CLONES double smallest_gap_of(const double* x, std::ptrdiff_t count) {
  double smallest = std::numeric_limits<double>::infinity(), sum = 0.0;
#pragma omp simd reduction(min : smallest) reduction(+ : sum)
  for (std::ptrdiff_t j = 0; j < count; ++j) {
    const double gap = x[j + 1] - x[j];
    smallest = gap < smallest ? gap : smallest;
    sum += 0.0 * gap;  // NaN if the gap is, which the comparison passes over
  }
  return smallest + sum;
}

/// The smaller of two gaps; NaN if one is.
double smaller(double a, double b) { return a < b || std::isnan(a) ? a : b; }

/// e^{i n w x/2} from e^{i w x/2}, by its real and imaginary part.
ACSTUDY_VECTOR_CLONES void powers_of_phases(const double* cosine, const double* sine, std::ptrdiff_t count, int n,
                                            double* power_cosine, double* power_sine) {
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

ACSTUDY_VECTOR_CLONES void difference(const double* a, const double* b, std::span<double> out) {
  for (std::size_t j = 0; j < out.size(); ++j) out[j] = a[j] - b[j];
}

}  // namespace

double midpoint_reach(double delta, double largest_gap) {
  return 0.625 * (std::max(delta, largest_gap) + sweeps().lanes * largest_gap);
}

namespace {

std::optional<MidpointModes> midpoint_modes(const TrigonometricSeries& of_c, const TrigonometricSeries& of_b) {
  MidpointModes modes;
  for (auto [series, field] : {std::pair(&of_c, &modes.c), std::pair(&of_b, &modes.b)}) {
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

}  // namespace

VelocitySeries::VelocitySeries(const Scene& scene) {
  const auto series = [&](const Field& field) {
    return trigonometric_series(field, scene.period(), most_series_modes);
  };
  c = series([&](auto x, auto out) { scene.c(x, out); });
  c_hat = c;
  if (scene.standing()) return;
  b = series([&](auto x, auto out) { scene.b(x, out); });
  b_prime = series([&](auto x, auto out) { scene.b_prime(x, out); });
  if (!b) c_hat.reset();
  if (!c_hat) return;
  modes = midpoint_modes(*c, *b);
  c_hat->constant -= b->constant;
  for (auto [coefficients, of_b] : {std::pair(&c_hat->cosine, &b->cosine), std::pair(&c_hat->sine, &b->sine)}) {
    coefficients->resize(std::max(coefficients->size(), of_b->size()));
    for (std::size_t i = 0; i < of_b->size(); ++i) (*coefficients)[i] -= (*of_b)[i];
  }
}

SharedParticles::SharedParticles(const Scene& scene, const VelocitySeries& velocity, std::vector<double> start,
                                 Needs needs, Team& team)
    : x(start.size()),
      scene_(scene),
      needs_(needs),
      team_(team),
      series_(velocity),
      start_(std::move(start)),
      wrapped_(std::min<std::ptrdiff_t>(32, x.margin())) {
  if (!scene.standing()) trajectories_.emplace(scene, start_);
  if (needs.midpoints) {
    modes = series_.modes;
    const std::size_t count = modes ? modes->number.size() : 0;
    mode_cosine.resize(count);
    mode_sine.resize(count);
  }
  needs_.c_and_b |= needs.c_hat && !series_.c_hat;
  const bool by_series = (needs.c_hat && series_.c_hat) || (needs_.c_and_b && (series_.c || series_.b)) ||
                         (needs.b_prime && series_.b_prime);
  // Positions must not differ by what else is needed.
  const bool by_phases = trajectories_ && trajectories_->by_phases();
  needs_.phases = needs.phases || modes || by_series || by_phases;
  const auto make = [&](bool needed, auto&... fields) {
    if (needed) ((fields = PeriodicArray(start_.size())), ...);
  };
  make(needs_.c_hat, c_hat);
  make(needs_.c_and_b, c, b);
  make(needs_.b_prime, b_prime);
  make(needs_.phases, cosine_, sine_);
  make(modes.has_value(), half_cosine_, half_sine_);
  for (std::size_t k = 0; k < mode_cosine.size(); ++k) make(true, mode_cosine[k], mode_sine[k]);
}

std::span<const double> SharedParticles::positions(double t) {
  return trajectories_ ? trajectories_->at(t) : std::span<const double>(start_);
}

void SharedParticles::move(double t, const AndThen& and_then) {
  const bool there = t == t_ || (t_ >= 0.0 && !trajectories_);
  if (there && !and_then) return;
  const bool each_alone = trajectories_ && trajectories_->closed_form() && t != 0.0;
  if (!there && !each_alone) {
    team_.timed(positions_seconds, [&] {
      const auto now = positions(t);
      std::copy(now.begin(), now.end(), x.values().begin());
    });
  }
  PerThread<double> smallest(team_, std::numeric_limits<double>::infinity());
  team_.each(std::ssize(x), grain, [&](const Piece& piece) {
    Laps laps(piece);
    if (!there) {
      place(each_alone ? std::optional(t) : std::nullopt, piece);
      smallest[piece] = smaller(smallest[piece], smallest_gap_of(x.at(piece.begin), piece.size() - 1));
      laps.end_of(positions_seconds);
      fill(piece);
      laps.end_of(velocities_seconds);
    }
    if (and_then) and_then(piece, laps);
  });
  if (there) return;
  team_.timed(positions_seconds, [&] {
    wrap_positions();
    smallest_gap_ = smallest.all(smaller);
    // Between the pieces, and from the last particle to the first.
    const std::ptrdiff_t count = std::ssize(x), step = team_.piece_size(count, grain);
    for (std::ptrdiff_t next = step; next - step < count; next += step) {
      const std::ptrdiff_t j = std::min(next, count);
      smallest_gap_ = smaller(smallest_gap_, x[j] - x[j - 1]);
    }
    // not (smallest <= 0), so that NaN is refused
    if (!(smallest_gap_ > 0.0)) {
      throw std::domain_error("particles have crossed: positions no longer increase within one period");
    }
    if (needs_.midpoints && !modes) fit_panels();
  });
  team_.timed(velocities_seconds, [&] { wrap_fields(); });
  t_ = t;
  ++times_moved_;
}

void SharedParticles::place(std::optional<double> t, const Piece& piece) {
  const auto part = [&](PeriodicArray& field) {
    return field.size() > 0 ? piece.of(field.values()) : std::span<double>();
  };
  const auto begin = static_cast<std::size_t>(piece.begin);
  const PhasesOut phases{part(cosine_), part(sine_), part(half_cosine_), part(half_sine_)};
  if (t && needs_.phases) {
    trajectories_->at(*t, begin, part(x), phases);
  } else if (t) {
    trajectories_->at(*t, begin, part(x));
  } else if (needs_.phases) {
    acstudy::phases(part(x), scene_.period(), phases);
  }
}

void SharedParticles::fill(const Piece& piece) {
  const auto part = [&](PeriodicArray& field) { return piece.of(field.values()); };
  const auto evaluate = [&](const std::optional<TrigonometricSeries>& series, PeriodicArray& field, auto&& directly) {
    series ? series->evaluate(phases(piece), part(field)) : directly(part(x), part(field));
  };
  if (needs_.c_and_b) {
    evaluate(series_.c, c, [&](auto at, auto out) { scene_.c(at, out); });
    if (!scene_.standing()) evaluate(series_.b, b, [&](auto at, auto out) { scene_.b(at, out); });
  }
  if (needs_.c_hat) {
    evaluate(series_.c_hat, c_hat, [&](auto, auto out) { difference(c.at(piece.begin), b.at(piece.begin), out); });
  }
  if (needs_.b_prime) evaluate(series_.b_prime, b_prime, [&](auto at, auto out) { scene_.b_prime(at, out); });
  if (!modes) return;
  for (std::size_t k = 0; k < modes->number.size(); ++k) {
    powers_of_phases(half_cosine_.at(piece.begin), half_sine_.at(piece.begin), piece.size(), modes->number[k],
                     &mode_cosine[k][piece.begin], &mode_sine[k][piece.begin]);
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
  if (needs_.c_hat) c_hat.wrap(needs_.rows ? reach : lanes);
  if (needs_.c_and_b) {
    b.wrap(reach);
    c.wrap(lanes);  // what a particle needs of itself alone is read up to the end of a vector
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
  const double* const right =
      std::partition_point(x.at(last), x.at(n + wrapped_ - 2), [&](double y) { return y - x[last] <= inside; });
  const double* const left =
      std::partition_point(x.at(3 - wrapped_), x.at(1), [&](double y) { return x[0] - y > inside; });
  return std::max(right - x.at(n) + 2, x.at(0) - left + 3) + looked_ahead;
}

}  // namespace acstudy
