#include "mms/scene.hpp"

#include <fmt/format.h>
#include <gsl/gsl_odeiv2.h>

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "mms/gsl_status.hpp"

namespace acstudy {

namespace {

Expression compile(const char* field, const std::string& text, const std::vector<std::string>& variables) {
  try {
    return Expression(text, variables);
  } catch (const ExpressionError& error) {
    throw SceneError(field, error.position, error.what());
  }
}

enum class Zero { allowed, refused };

double constant(const char* field, const std::string& text, Zero zero) {
  const double value = compile(field, text, {})({});
  if (!std::isfinite(value) || value < 0.0 || (value == 0.0 && zero == Zero::refused)) {
    throw SceneError(field, 0,
                     fmt::format("{} = {:.6g}; it must be {} and finite", field, value,
                                 zero == Zero::allowed ? "zero or positive" : "positive"));
  }
  return value;
}

/// Points of the period in increasing order, at multiples of the golden ratio: no field of a smaller period is sampled
/// at its own multiples only, however small that period is.
std::vector<double> samples(double period) {
  constexpr int count = 257;
  std::vector<double> x(count);
  for (int i = 0; i < count; ++i) x[i] = period * std::fmod(i * std::numbers::phi, 1.0);
  std::sort(x.begin(), x.end());
  return x;
}

/// The other points at which fields are looked at: those where uniform particles start at most of the usual N.
std::vector<double> usual_starts(double period) {
  constexpr int count = 2560;
  std::vector<double> x(count);
  for (int i = 0; i < count; ++i) x[i] = period * i / count;
  return x;
}

std::string at_place(double x, double t, const Expression& field) {
  return fmt::format("x = {:.6g}{}", x, field.depends_on(1) ? fmt::format(", t = {:.6g}", t) : "");
}

/// Fails if the field or one of its derivatives is not finite at one of the points.
void check_finite(const char* name, const Expression& field, std::span<const double> x, double t) {
  std::vector<double> value(x.size()), by_x(x.size()), by_t(field.depends_on(1) ? x.size() : 0);
  field.evaluate(x, {t}, {value, by_x, by_t});
  const auto check = [&](const std::vector<double>& values, const std::string& what, const char* must) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::isfinite(values[i])) continue;
      const double shown = std::isnan(values[i]) ? std::abs(values[i]) : values[i];
      throw SceneError(name, 0, fmt::format("{} is {} at {}; {}", what, shown, at_place(x[i], t, field), must));
    }
  };
  constexpr const char* smooth = "sources are made of it: write a field that has a derivative there";
  check(value, name, "it must be finite everywhere");
  check(by_x, fmt::format("the derivative of {} by x", name), smooth);
  check(by_t, fmt::format("the derivative of {} by t", name), smooth);
}

/// Fails if the field has a pole where it is largest: if a millionth of the period beside it is a thousand times less.
void check_bounded(const char* name, const Expression& field, std::span<const double> x, double t, double period) {
  const auto size = [&](double at) {
    double value = 0.0;
    field.evaluate({&at, 1}, {t}, {{&value, 1}, {}, {}});
    return std::abs(value);
  };
  std::vector<double> values(x.size());
  field.evaluate(x, {t}, {values, {}, {}});
  const auto smaller = [](double a, double b) { return std::abs(a) < std::abs(b); };
  const auto top = std::max_element(values.begin(), values.end(), smaller);
  const double here = x[static_cast<std::size_t>(top - values.begin())];
  // Golden-section search for the largest size in the two cells around it, down to the last digits.
  double left = here - period / static_cast<double>(x.size()), right = here + period / static_cast<double>(x.size());
  while (right - left > 4e-16 * period) {
    const double part = (right - left) / (1.0 + std::numbers::phi), a = left + part, b = right - part;
    if (!(left < a && a < b && b < right)) break;
    (size(a) < size(b) ? left : right) = size(a) < size(b) ? a : b;
  }
  const double peak = size(here) > size(left) ? here : left, most = size(peak);
  constexpr double apart = 1e-6, too_much = 1e3;
  const double beside = std::max(size(peak - apart * period), size(peak + apart * period));
  if (std::isfinite(most) && most <= too_much * beside) return;
  throw SceneError(
      name, 0,
      fmt::format("{} has a pole at {}: it grows to {:.3g} there, from {:.3g} at {:.1g} beside; write a field "
                  "that is bounded",
                  name, at_place(peak, t, field), most, beside, apart * period));
}

}  // namespace

std::string SceneText::solution() const { return u0 ? fmt::format("u0={}|f={}", *u0, f.value_or("0")) : u; }

Scene::Scene(SceneText text)
    : text_(std::move(text)),
      period_(constant("period", text_.period, Zero::refused)),
      T_(constant("T", text_.T, Zero::allowed)),
      c_(compile("c", text_.c, {"x"})) {
  if (text_.b) {
    b_ = compile("b", *text_.b, {"x"});
    check_periodic("b", *b_);
    if (b_->is_constant() && (*b_)({0.0}) == 0.0) b_.reset();
  }
  if (text_.flow) {
    if (!b_) throw SceneError("flow", 0, "a flow without b; particles stand still unless b is given");
    flow_ = compile("flow", *text_.flow, {"x", "t"});
    check_flow();
  }
  check_periodic("c", c_);
  const std::vector<double> starts = usual_starts(period_);
  const auto check = [&](const char* name, const Expression& field) {
    for (const double t : {0.0, 0.37 * T_, T_}) {
      check_finite(name, field, samples(period_), t);
      check_finite(name, field, starts, t);
      check_bounded(name, field, starts, t, period_);
      if (!field.depends_on(1)) break;
    }
  };
  check("c", c_);
  if (b_) check("b", *b_);
  if (!text_.u0) {
    u_ = compile("u", text_.u, {"x", "t"});
    check_periodic("u", *u_);
    check("u", *u_);
    return;
  }
  u0_ = compile("u0", *text_.u0, {"x"});
  check_periodic("u0", *u0_);
  check("u0", *u0_);
  if (!text_.f) return;
  f_ = compile("f", *text_.f, {"x", "t"});
  check_periodic("f", *f_);
  check("f", *f_);
  if (f_->is_constant() && (*f_)({0.0, 0.0}) == 0.0) f_.reset();
}

double Scene::solution_size(std::span<const double> x, double t) const {
  std::vector<double> values(x.size());
  const auto largest = [](std::span<const double> of) {
    double most = 0.0;
    for (const double value : of) most = std::max(most, std::abs(value));
    return most;
  };
  if (solved()) {
    u(x, t, values);
    return largest(values);
  }
  const auto points = samples(period_);
  values.resize(points.size());
  initial(points, values);
  double size = largest(values);
  if (f_) {
    constexpr int times = 64;
    double source = 0.0;
    for (int i = 0; i <= times; ++i) {
      f(points, t * i / times, values);
      source = std::max(source, largest(values));
    }
    size += t * source;
  }
  std::vector<double> slope(points.size());
  c(points, values, slope);
  return size * std::exp(t * largest(slope));
}

void Scene::check_periodic(const char* field, const Expression& expression) const {
  const auto x = samples(period_);
  std::vector<double> shifted(x), here(x.size()), there(x.size());
  for (double& value : shifted) value += period_;
  for (const double t : {0.0, 0.37 * T_, T_}) {
    expression.evaluate(x, {t}, {here, {}, {}});
    expression.evaluate(shifted, {t}, {there, {}, {}});
    double scale = 0.0, gap = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      for (const auto& [value, at] : {std::pair(here[i], x[i]), std::pair(there[i], shifted[i])}) {
        if (std::isfinite(value)) continue;
        throw SceneError(field, 0,
                         fmt::format("{} is {} at x = {:.6g}; it must be finite everywhere", field,
                                     std::isnan(value) ? std::abs(value) : value, at));
      }
      scale = std::max(scale, std::abs(here[i]));
      gap = std::max(gap, std::abs(here[i] - there[i]));
    }
    if (!(gap <= 1e-9 * scale)) {
      throw SceneError(
          field, 0,
          fmt::format("{0} is not periodic: {0}(x + {1:.6g}) and {0}(x) differ by {2:.3g}", field, period_, gap));
    }
  }
}

void Scene::check_flow() const {
  const auto x = samples(period_);
  std::vector<double> position(x.size()), speed(x.size()), b(x.size());
  for (const double t : {0.0, 0.37 * T_, T_}) {
    flow_->evaluate(x, {t}, {position, {}, speed});
    this->b(x, b);
    // Particles may have gathered where b is small.
    double scale = 0.0, gap = 0.0;
    for (const double value : b) scale = std::max(scale, std::abs(value));
    this->b(position, b);
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (t == 0.0 && !(std::abs(position[i] - x[i]) <= 1e-9 * period_)) {
        throw SceneError(
            "flow", 0,
            fmt::format("the flow at t = 0 takes x = {:.6g} to {:.6g}; it must leave it there", x[i], position[i]));
      }
      const double difference = std::abs(speed[i] - b[i]);
      gap = std::max(gap, std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference);
    }
    if (!(gap <= 1e-9 * std::max(scale, 1e-300))) {
      throw SceneError("flow", 0,
                       fmt::format("the flow does not follow b: its velocity differs from b by {:.3g} at t = {:.3g}; "
                                   "leave it out to have it integrated",
                                   gap, t));
    }
    if (!std::is_sorted(position.begin(), position.end()) || !(position.back() < position.front() + period_)) {
      throw SceneError("flow", 0,
                       fmt::format("the flow does not keep particles in order at t = {:.3g}; it may jump where "
                                   "it wraps around the period",
                                   t));
    }
  }
}

double Scene::max_relative_velocity() const {
  constexpr int count = 4096;
  std::vector<double> x(count), relative(count), b_values(count, 0.0);
  for (int i = 0; i < count; ++i) x[i] = period_ * i / count;
  const auto fill = [&](std::span<const double> points, std::span<double> out, std::span<double> scratch) {
    c(points, out);
    if (!standing()) b(points, scratch);
    for (std::size_t i = 0; i < points.size(); ++i) out[i] = std::abs(out[i] - (standing() ? 0.0 : scratch[i]));
  };
  fill(x, relative, b_values);
  const auto top = std::max_element(relative.begin(), relative.end());
  const double middle = x[top - relative.begin()], cell = period_ / count;
  const auto negative = [&](double point) {
    double value = 0.0, scratch = 0.0;
    fill({&point, 1}, {&value, 1}, {&scratch, 1});
    return -value;
  };
  const auto [point, value] = boost::math::tools::brent_find_minima(negative, middle - cell, middle + cell, 52);
  return std::max(*top, -value);
}

Trajectories::Trajectories(const Scene& scene, std::vector<double> start) : scene_(scene), x_(std::move(start)) {
  if (!scene.flow()) return;
  at_start_.emplace(*scene.flow(), x_);
  angle_ = scene.flow()->angle(scene.period() / std::numbers::pi);
}

void Trajectories::at(double t, std::size_t begin, std::span<double> x, const PhasesOut& phases) const {
  if (angle_) {
    scene_.flow()->evaluate(*at_start_, *angle_, begin, {t}, phases.sine, phases.cosine);
    phases_of_angles(scene_.period(), x, phases);
  } else {
    at(t, begin, x);
    acstudy::phases(x, scene_.period(), phases);
  }
}

std::span<const double> Trajectories::at(double t) {
  if (t == t_) return x_;
  if (scene_.flow()) {
    at(t, 0, x_);
  } else {
    constexpr double tolerance = 1e-14;
    gsl_odeiv2_system system{[](double, const double x[], double dxdt[], void* flow) {
                               const auto& self = *static_cast<const Trajectories*>(flow);
                               self.scene_.b({x, self.x_.size()}, {dxdt, self.x_.size()});
                               return static_cast<int>(GSL_SUCCESS);
                             },
                             nullptr, x_.size(), this};
    const std::unique_ptr<gsl_odeiv2_driver, decltype(&gsl_odeiv2_driver_free)> driver(
        gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, t - t_, tolerance, tolerance),
        gsl_odeiv2_driver_free);
    // Between two stages a smooth flow takes one step or a few.
    gsl_odeiv2_driver_set_nmax(driver.get(), 10000);
    double now = t_;
    std::vector<double> x = x_;
    if (gsl_odeiv2_driver_apply(driver.get(), &now, t, x.data()) != GSL_SUCCESS) {
      throw std::domain_error(fmt::format("the flow x' = b(x) cannot be integrated from t = {} to {}", t_, t));
    }
    x_ = std::move(x);
  }
  t_ = t;
  return x_;
}

const std::vector<SceneText>& named_scenes() {
  static const std::vector<SceneText> scenes = {
      {.name = "lee-du-2019",
       .period = "2*pi",
       .T = "1",
       .c = "cos(2*x)/3",
       .b = "sin(x)",
       .u = "cos(x - t)",
       .flow = "2*atan2(sin(x/2)*exp(t), cos(x/2))"},
      {.name = "standing-variable-velocity",
       .period = "2*pi",
       .T = "1",
       .c = "1 + sin(x)/2",
       .b = std::nullopt,
       .u = "sin(x - t) + cos(2*x)/4",
       .flow = std::nullopt},
      {.name = "constant-velocity",
       .period = "1",
       .T = "1/2",
       .c = "1",
       .b = std::nullopt,
       .u = "sin(2*pi*(x - t))",
       .flow = std::nullopt},
      {.name = "lagrangian",
       .period = "2*pi",
       .T = "1",
       .c = "sin(x)",
       .b = "sin(x)",
       .u = "2 + cos(x - t)",
       .flow = "2*atan2(sin(x/2)*exp(t), cos(x/2))"},
  };
  return scenes;
}

}  // namespace acstudy
