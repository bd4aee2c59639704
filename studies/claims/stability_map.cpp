#include "studies/claims/stability_map.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "studies/claims/stability.hpp"

namespace acstudy {

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
/// Row sums and eigenvalues of some hundred terms, relative.
constexpr double round_off = 1e-11;

/// What the bounds on a subject's steps are made of.
struct Constants {
  double C;            ///< ||c_hat'|| + ||b'||, exactly 0 where both fields are constant
  double b_1;          ///< ||b'||
  double speed;        ///< max |c_hat|
  double lemma_speed;  ///< `StepLemma::speed`

  explicit Constants(const Subject& subject)
      : speed(subject.scene->max_relative_velocity()),
        lemma_speed(subject.scheme.model->step_lemma.speed(*subject.scene, subject.mu)) {
    const FieldBounds fields = field_bounds(*subject.scene, 0.0);
    C = fields.c_hat_1 + fields.b_1;
    b_1 = fields.b_1;
  }
};

/// A viscous model: mu reach_j >= max|c_hat| |x_i - x_j| for all neighbors, so that no neighbor's coefficient is
/// negative.
bool viscosity_suffices(const Subject& subject, const PlacedScheme& placed, double speed) {
  if (!subject.scheme.model->viscous) return true;
  const Particles& particles = placed.particles();
  for (std::ptrdiff_t j = 0; j < std::ssize(particles.x); ++j) {
    const double* const x = particles.x.at(j);
    const double farthest = std::max(x[0] - x[-particles.windows.left[j]], x[particles.windows.right[j]] - x[0]);
    if (subject.mu * std::max(particles.delta, farthest) < speed * farthest * (1.0 - round_off)) return false;
  }
  return true;
}

/// A subject on particles that stand for a while: its rates, and the steps that the two conditions allow.
struct Frozen {
  SparseMatrix R;
  double lemma;  ///< the step that the lemma allows: CFL number 1
  double rows;   ///< the step that the rows allow; 0 where none is monotone

  Frozen(const Subject& subject, const Constants& constants, const std::vector<double>& x, double delta) {
    PlacedScheme placed(subject.scheme, *subject.scene, subject.mu, x, delta);
    R = sparse_rates(placed);
    lemma = gaps(x, subject.scene->period()).smallest / constants.lemma_speed;
    const auto decay = [&] {
      if (subject.scheme.control == nullptr) return placed.scheme().rows()->strongest_decay();
      // A control is stepped as the scheme that it is taken for.
      SchemeChoice itself = subject.scheme;
      itself.control = nullptr;
      return PlacedScheme(itself, *subject.scene, subject.mu, x, delta).scheme().rows()->strongest_decay();
    };
    rows = subject.scheme.model->step_lemma.promised && viscosity_suffices(subject, placed, constants.speed)
               ? 1.0 / decay()
               : 0.0;
  }

  /// Of R; computed once for all steps.
  const Eigen::VectorXcd& eigenvalues() const {
    if (!eigenvalues_) eigenvalues_ = acstudy::eigenvalues(Eigen::MatrixXd(R));
    return *eigenvalues_;
  }

 private:
  mutable std::optional<Eigen::VectorXcd> eigenvalues_;
};

/// Those of all particles of the subject's arrangement.
std::vector<Frozen> all_frozen(const Subject& subject, const Constants& constants, std::int64_t N, double delta) {
  std::vector<Frozen> all;
  for (const std::vector<double>& x : subject.positions(N)) all.emplace_back(subject, constants, x, delta);
  return all;
}

/// The largest dt at which the integrator's stability function phi(C dt) has no pole yet.
double up_to_the_pole(const Integrator& integrator, double C) {
  const bool promised = monotonicity_radius(integrator) > 0.0;
  return integrator.implicit() && C > 0.0 && promised ? 1.0 / (integrator.diagonal(1) * C) : unbounded;
}

/// phi(C dt), to which theory bounds the norm of a step within the condition; infinite beyond the pole. Where it bounds
/// no step, e^{C dt}, as the solution may grow.
double phi(const Integrator& integrator, double C, double dt) {
  if (monotonicity_radius(integrator) == 0.0) return std::exp(C * dt);
  return dt < up_to_the_pole(integrator, C) ? stability_function(integrator, C * dt).real() : unbounded;
}

/// Bound on the norm of a step, infinite where theory gives none.
double step_bound(const Integrator& integrator, double dt, double rows, double C) {
  const bool within = rows > 0.0 && dt <= monotonicity_radius(integrator) * rows * (1.0 + 1e-12);
  return within ? phi(integrator, C, dt) : unbounded;
}

/// How many times forward Euler's steps theory allows; 0 where it bounds no step.
double promised_radius(const Subject& subject, const Integrator& integrator) {
  return subject.scheme.model->step_lemma.promised ? monotonicity_radius(integrator) : 0.0;
}

/// What step_bound says, in words.
std::string step_claim(const Subject& subject, const Integrator& integrator) {
  const double radius = promised_radius(subject, integrator);
  if (std::isinf(radius)) return "a step grows by no more than 1/(1 - C dt), at any CFL number with C dt < 1";
  if (radius == 0.0) return "theory bounds the growth of no step";
  return fmt::format("a step grows by no more than phi(C dt), up to {}the condition of the rows",
                     radius == 1.0 ? "" : "1 + sqrt(2) times ");
}

bool is_bounded(const Point& point) { return std::isfinite(point.lower) || std::isfinite(point.upper); }

/// A measurement whose values theory may turn out to bound nowhere.
Measurement bounded_if_at_all(const Check& check, std::function<void(Finding&)> measure) {
  return {check, [measure = std::move(measure)](Finding& finding) {
            measure(finding);
            if (std::none_of(finding.points.begin(), finding.points.end(), is_bounded)) finding.expect_no_bound();
          }};
}

Check check_of(const Subject& subject, const Integrator& integrator, const std::string& statement,
               const std::string& claim, const std::string& quantity, const std::string& variable) {
  Check check = subject.check(fmt::format("{}, {}", subject.scheme.model->step_lemma.name, statement), claim,
                              {{"integrator", std::string(integrator.name)},
                               unspoken({"lemma", std::string(subject.scheme.model->step_lemma.name)}),
                               unspoken({"measure", quantity})},
                              quantity);
  check.variable = variable;
  if (subject.scheme.control != nullptr) check.be_control("unstable at any step");
  return check;
}

/// The product of all steps from the uniform start to T along the motion, at a CFL number; `seen(t, norm, bound)` after
/// each step, with the bound on the norm of the product.
template <class Seen>
void product_along_motion(const Subject& subject, const Integrator& integrator, std::int64_t N, double delta,
                          double cfl, Seen&& seen) {
  const Scene& scene = *subject.scene;
  const Constants constants(subject);
  Trajectories trajectories(scene, uniform_positions(static_cast<std::size_t>(N), scene.period()));
  std::optional<Frozen> now;
  double now_at = -1.0;
  const auto frozen_at = [&](double t) -> const Frozen& {
    if (t != now_at) {
      const auto x = trajectories.at(t);
      now.emplace(subject, constants, std::vector<double>(x.begin(), x.end()), delta);
      now_at = t;
    }
    return *now;
  };
  BoundedSteps steps(scene.T(), [&](double t) { return cfl * frozen_at(t).lemma; });
  Eigen::MatrixXd product = Eigen::MatrixXd::Identity(N, N);
  double bound = 1.0;
  double least_rows = unbounded;
  const RatesAt rates = [&](double t) -> const SparseMatrix& {
    const Frozen& frozen = frozen_at(t);
    least_rows = std::min(least_rows, frozen.rows);
    return frozen.R;
  };
  MatrixSystem system(rates, product);
  integrate(integrator, system, steps, system, [&](std::int64_t, const TimeStep& step) {
    bound *= step_bound(integrator, step.dt, std::exchange(least_rows, unbounded), constants.C);
    const double norm = max_norm(product);
    seen(step.end, norm, bound < largest_norm ? bound * (1.0 + round_off) : unbounded);
    return norm != largest_norm;
  });
}

struct Measured {
  double value, bound;
};

/// The worst of the arrangement's particles, which is the one nearest to its bound or beyond; where none is bounded,
/// the largest.
template <class Take>
Point worst_of(const std::vector<Frozen>& all, Take&& take) {
  Point worst{.value = NAN};
  for (const Frozen& frozen : all) {
    const Measured now = take(frozen);
    const bool first = std::isnan(worst.value), bounded = std::isfinite(now.bound), was = std::isfinite(worst.upper);
    if (first || (bounded && !was) ||
        (bounded == was && now.value / (was ? now.bound : 1.0) > worst.value / (was ? worst.upper : 1.0))) {
      worst.value = now.value;
      worst.upper = now.bound;
    }
  }
  return worst;
}

/// Measures steps on frozen particles.
class FrozenMeter {
 public:
  FrozenMeter(const Integrator& integrator, const Frozen& frozen, Measure measure)
      : integrator_(integrator), frozen_(frozen), measure_(measure) {}
  double operator()(double dt) const {
    if (measure_ == Measure::spectral) return spectral_radius(integrator_, frozen_.eigenvalues(), dt);
    return max_norm(step_operator(integrator_, frozen_.R, dt));
  }

 private:
  const Integrator& integrator_;
  const Frozen& frozen_;
  Measure measure_;
};

bool relative_velocity_keeps_its_sign(const Scene& scene) {
  const std::vector<double> x = uniform_positions(4096, scene.period());
  std::vector<double> c_hat(x.size()), b(x.size(), 0.0);
  scene.c(x, c_hat);
  if (!scene.standing()) scene.b(x, b);
  for (std::size_t j = 0; j < x.size(); ++j) c_hat[j] -= b[j];
  const auto [lowest, highest] = std::minmax_element(c_hat.begin(), c_hat.end());
  return *lowest > 0.0 || *highest < 0.0;
}

/// Whether theory says that no entry of a step is negative; see smallest_entry.
bool entries_are_promised(const Subject& subject, const Integrator& integrator, const Frozen& frozen,
                          const Constants& constants, double dt) {
  const double radius = monotonicity_radius(integrator);
  const bool any_step = std::isinf(radius), within = frozen.rows > 0.0 && dt <= radius * frozen.rows * (1.0 + 1e-12);
  const ModelCard& model = *subject.scheme.model;
  if (model.beyond_paper) return model.step_lemma.promised && constants.C == 0.0 && (any_step || within);
  if (model.upwind) return any_step ? constants.b_1 * dt < 1.0 : within && subject.scene->standing();
  return within && (any_step ? constants.C * dt < 1.0 : constants.C == 0.0);
}

std::string entries_claim(const Subject& subject, const Integrator& integrator) {
  const StepLemma& lemma = subject.scheme.model->step_lemma;
  const double radius = promised_radius(subject, integrator);
  if (std::isinf(radius)) return std::string(lemma.m_matrix);
  if (radius == 0.0) return "theory keeps the entries of no step positive";
  return fmt::format("no entry of a step is negative up to {}the condition of the rows, {}",
                     radius == 1.0 ? "" : "1 + sqrt(2) times ", lemma.where_positive);
}

/// A row of the map: a measure at a horizon and all CFL numbers.
void measure_row(Finding& finding, const Subject& subject, const Integrator& integrator, const Constants& constants,
                 const StabilityGrid& grid, double ratio, Measure measure) {
  const double h = subject.scene->period() / static_cast<double>(grid.N),
               delta = ratio * subject.scene->period() / static_cast<double>(grid.N);
  const bool moving = measure == Measure::growth && subject.arrangement == Arrangement::moved;
  const std::vector<Frozen> all = moving ? std::vector<Frozen>() : all_frozen(subject, constants, grid.N, delta);
  const double C = constants.C, T = subject.scene->T();
  for (const double cfl : grid.cfl) {
    Point point;
    if (moving) {
      product_along_motion(subject, integrator, grid.N, delta, cfl, [&](double, double norm, double bound) {
        point.value = norm;
        point.upper = bound;
      });
    } else {
      point = worst_of(all, [&](const Frozen& frozen) -> Measured {
        const double dt = cfl * frozen.lemma, bound = step_bound(integrator, dt, frozen.rows, C);
        if (measure != Measure::growth)
          return {FrozenMeter(integrator, frozen, measure)(dt), bound * (1.0 + round_off)};
        const std::int64_t n = steps_for(T, dt);
        const double equal = T / static_cast<double>(n);
        const double total = std::pow(step_bound(integrator, equal, frozen.rows, C), static_cast<double>(n));
        return {norm_of_power(step_operator(integrator, frozen.R, equal), n), total * (1.0 + 1e-9)};
      });
    }
    // The horizon over its ratio is h but for round-off.
    point.N = grid.N;
    point.h = moving ? delta / ratio : h;
    point.delta = delta;
    point.variable = cfl;
    finding.points.push_back(point);
  }
}

/// The first CFL number that is not stable, a quarter farther each time; then between it and the last stable one.
template <class Stable>
double last_stable(Stable&& stable, double highest) {
  double low = 1e-3, high = low;
  if (!stable(low)) return 0.0;
  while (high < highest && stable(high = std::min(1.25 * high, highest))) low = high;
  while (low < highest && high - low > 1e-9 * low) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

/// Whether theory gives the limit itself, and not only that it is no smaller.
bool limit_is_exact(const Subject& subject, const Integrator& integrator, Measure measure, double C) {
  return C == 0.0 && measure == Measure::norm && integrator.name == forward_euler.name &&
         subject.scheme.control == nullptr && !subject.scheme.model->step_lemma.sharp.empty();
}

/// The smallest limit of the arrangement's particles, unless another one is not within its bounds.
Point limit_at(const Subject& subject, const Integrator& integrator, const Constants& constants, std::int64_t N,
               double ratio, Measure measure, double highest) {
  const double delta = ratio * subject.scene->period() / static_cast<double>(N), C = constants.C;
  const bool exact = limit_is_exact(subject, integrator, measure, C);
  Point worst{.N = N, .h = delta / ratio, .delta = delta, .variable = ratio, .value = NAN};
  for (const std::vector<double>& x : subject.positions(N)) {
    const Frozen frozen(subject, constants, x, delta);
    const FrozenMeter meter(integrator, frozen, measure);
    const double pole = up_to_the_pole(integrator, C);
    const auto stable = [&](double cfl) {
      const double dt = cfl * frozen.lemma;
      return dt < pole && meter(dt) <= phi(integrator, C, dt) * (1.0 + round_off);
    };
    const double limit = last_stable(stable, highest);
    const double promised = frozen.rows > 0.0 ? std::min(monotonicity_radius(integrator) * frozen.rows, pole) : 0.0;
    const double least = std::min(promised / frozen.lemma, highest);
    const bool any = promised_radius(subject, integrator) > 0.0;
    const double lower = any ? least * (1.0 - 1e-6) : -unbounded, upper = exact ? least * (1.0 + 1e-6) : unbounded;
    const bool within = lower <= limit && limit <= upper,
               was = worst.lower <= worst.value && worst.value <= worst.upper;
    if (std::isnan(worst.value) || (was && (!within || limit < worst.value))) {
      worst.value = limit;
      worst.lower = lower;
      worst.upper = upper;
    }
  }
  return worst;
}

void measure_growth(Finding& finding, const Subject& subject, const Integrator& integrator, std::int64_t N,
                    double ratio, double cfl) {
  const Constants constants(subject);
  const double h = subject.scene->period() / static_cast<double>(N), delta = ratio * h;
  const auto seen = [&](double t, double norm, double bound) {
    finding.points.push_back({.N = N, .h = h, .delta = delta, .variable = t, .value = norm, .upper = bound});
  };
  if (!subject.scene->standing()) {
    product_along_motion(subject, integrator, N, delta, cfl, seen);
  } else {
    const Frozen frozen(subject, constants, subject.positions(N).front(), delta);
    const std::int64_t n = steps_for(subject.scene->T(), cfl * frozen.lemma);
    const double dt = subject.scene->T() / static_cast<double>(n);
    const double step = step_bound(integrator, dt, frozen.rows, constants.C);
    const Eigen::MatrixXd S = step_operator(integrator, frozen.R, dt);
    Eigen::MatrixXd power = S;
    for (std::int64_t i = 1; i <= n && max_norm(power) < largest_norm; ++i) {
      const double t = static_cast<double>(i) * dt;
      seen(t, max_norm(power), std::pow(step, static_cast<double>(i)) * (1.0 + 1e-9));
      power = product(S, power);
    }
  }
}

void measure_smallest_entries(Finding& finding, const Subject& subject, const Integrator& integrator,
                              const StabilityGrid& grid) {
  const Scene& scene = *subject.scene;
  const Constants constants(subject);
  for (const double ratio : grid.ratios) {
    const double delta = ratio * scene.period() / static_cast<double>(grid.N);
    const std::vector<Frozen> all = all_frozen(subject, constants, grid.N, delta);
    for (const double cfl : grid.cfl) {
      Point worst{.N = grid.N, .h = delta / ratio, .delta = delta, .variable = cfl, .value = unbounded};
      for (const Frozen& frozen : all) {
        const double dt = cfl * frozen.lemma;
        const double value = step_operator(integrator, frozen.R, dt).minCoeff();
        const bool promised = entries_are_promised(subject, integrator, frozen, constants, dt);
        // What is promised counts before what is not.
        const bool was = std::isfinite(worst.lower);
        if ((promised && !was) || (promised == was && value < worst.value)) {
          worst.value = value;
          worst.lower = promised ? -round_off : -unbounded;
        }
      }
      finding.points.push_back(worst);
    }
  }
}

}  // namespace

const char* quantity_of(Measure measure) {
  switch (measure) {
    case Measure::norm:
      return "max norm of a step";
    case Measure::spectral:
      return "spectral radius of a step";
    case Measure::growth:
      return "max norm of all steps to T";
  }
  return "";
}

Measurement stability_map(const Subject& subject, const Integrator& integrator, const StabilityGrid& grid,
                          Measure measure) {
  return bounded_if_at_all(
      check_of(subject, integrator, "map", step_claim(subject, integrator), quantity_of(measure), "CFL number"),
      [=, &integrator](Finding& finding) {
        const Constants constants(subject);
        for (const double ratio : grid.ratios) {
          measure_row(finding, subject, integrator, constants, grid, ratio, measure);
        }
      });
}

Measurement sharp_limit(const Subject& subject, const Integrator& integrator, const StabilityGrid& grid,
                        Measure measure, double highest) {
  const Constants constants(subject);
  const bool of_norm = measure == Measure::norm;
  const std::string claim(limit_is_exact(subject, integrator, measure, constants.C)
                              ? subject.scheme.model->step_lemma.sharp
                          : promised_radius(subject, integrator) == 0.0 ? "theory promises no step"
                                                                        : "stable as far as the rows need, at least");
  return bounded_if_at_all(
      check_of(subject, integrator, of_norm ? "sharp in the max norm" : "sharp in the spectral radius", claim,
               of_norm ? "largest CFL number, max norm" : "largest CFL number, spectral radius", "delta/h"),
      [=, &integrator](Finding& finding) {
        for (const double ratio : grid.ratios) {
          finding.points.push_back(limit_at(subject, integrator, constants, grid.N, ratio, measure, highest));
        }
      });
}

Measurement growth_curve(const Subject& subject, const Integrator& integrator, std::int64_t N, double ratio,
                         double cfl) {
  Check check =
      check_of(subject, integrator, "growth curve", step_claim(subject, integrator), "max norm of all steps to t", "t");
  check.coordinates.insert(check.coordinates.begin() + 2, {at_ratio(ratio), at_cfl(cfl)});
  return bounded_if_at_all(
      check, [=, &integrator](Finding& finding) { measure_growth(finding, subject, integrator, N, ratio, cfl); });
}

Measurement smallest_entry(const Subject& subject, const Integrator& integrator, const StabilityGrid& grid) {
  Check check = check_of(subject, integrator, "positivity", entries_claim(subject, integrator),
                         "smallest entry of a step", "CFL number");
  if (subject.scheme.model->upwind && !relative_velocity_keeps_its_sign(*subject.scene)) {
    check.expected = Verdict::violated;
    check.remark =
        "where c - b rises through zero, a particle sees neighbors whose velocity has the other sign; their entries "
        "are "
        "negative at any step";
  }
  return bounded_if_at_all(
      check, [=, &integrator](Finding& finding) { measure_smallest_entries(finding, subject, integrator, grid); });
}

}  // namespace acstudy
