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

Expression compile(const char* field, const std::string& text, const std::vector<std::string>& variables,
                   std::size_t components = 1) {
  try {
    return Expression(text, variables, components);
  } catch (const ExpressionError& error) {
    throw SceneError(field, error.position, error.what());
  }
}

enum class Zero { allowed, refused };

/// One of each of the components.
std::vector<double> constants(const char* field, const std::string& text, Zero zero, std::size_t components = 1) {
  std::vector<double> values(components);
  const double anywhere = 0.0;
  compile(field, text, {}, components).evaluate({&anywhere, 1}, {}, {.value = Vectors::blocks(values, components)});
  for (double& value : values) {
    if (std::isnan(value)) value = std::abs(value);
    if (std::isfinite(value) && (value > 0.0 || (value == 0.0 && zero == Zero::allowed))) continue;
    throw SceneError(field, 0,
                     fmt::format("{} = {:.6g}; it must be {} and finite", field, value,
                                 zero == Zero::allowed ? "zero or positive" : "positive"));
  }
  return values;
}

/// The coordinates, and time if the field has one.
std::vector<std::string> variables(std::size_t dimension, bool time) {
  std::vector<std::string> names(coordinate_names, coordinate_names + dimension);
  if (time) names.emplace_back("t");
  return names;
}

/// Points of the period, on a line in increasing order, at multiples of the golden ratio: no field of a smaller period
/// is sampled at its own multiples only, however small that period is. Other coordinates at those of other roots.
PointArray samples(const std::vector<double>& periods) {
  constexpr int count = 257;
  constexpr double ratios[most_dimensions] = {std::numbers::phi, std::numbers::sqrt2, std::numbers::sqrt3};
  PointArray x{std::vector<double>(periods.size() * count), periods.size()};
  for (std::size_t k = 0; k < periods.size(); ++k) {
    for (int i = 0; i < count; ++i) x(i, k) = periods[k] * std::fmod(i * ratios[k], 1.0);
  }
  std::sort(x.coordinates.begin(), x.coordinates.begin() + count);
  return x;
}

/// The other points at which fields are looked at: those where uniform particles start at most of the usual N; in a box
/// fewer a side.
constexpr std::size_t starts_on_side[most_dimensions] = {2560, 60, 15};
PointArray usual_starts(const std::vector<double>& periods) {
  const std::size_t side = starts_on_side[periods.size() - 1];
  std::size_t count = 1, turn = 1;
  for (std::size_t k = 0; k < periods.size(); ++k) count *= side;
  PointArray x{std::vector<double>(periods.size() * count), periods.size()};
  for (std::size_t k = 0; k < periods.size(); ++k, turn *= side) {
    for (std::size_t i = 0; i < count; ++i) {
      x(i, k) = periods[k] * static_cast<double>(i / turn % side) / static_cast<double>(side);
    }
  }
  return x;
}

std::string at_place(const Points& x, std::size_t i, double t, const Expression& field) {
  return place_of(x, i) + (field.depends_on(x.dimension()) ? fmt::format(", t = {:.6g}", t) : "");
}

bool is_zero(const Expression& field, std::size_t dimension) {
  if (!field.is_constant()) return false;
  const std::vector<double> origin(dimension, 0.0);
  std::vector<double> value(field.components());
  field.evaluate(Points::blocks(origin, dimension), {0.0}, {.value = Vectors::blocks(value, field.components())});
  return std::all_of(value.begin(), value.end(), [](double one) { return one == 0.0; });
}

/// Fails if the field or one of its derivatives is not finite at one of the points.
void check_finite(const char* name, const Expression& field, const Points& x, double t) {
  const std::size_t count = x.size(), dimension = x.dimension(), components = field.components();
  const bool is_vector = components > 1;
  std::vector<double> value(components * count), by_t(field.depends_on(dimension) ? count : 0);
  std::vector<double> slopes((is_vector ? 1 : dimension) * count);
  field.evaluate(x, {t},
                 {.value = Vectors::blocks(value, components),
                  .gradient = is_vector ? Vectors() : Vectors::blocks(slopes, dimension),
                  .by_parameter = by_t,
                  .divergence = is_vector ? std::span(slopes) : std::span<double>()});
  const auto check = [&](std::span<const double> values, const std::string& what, const char* must) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::isfinite(values[i])) continue;
      const double shown = std::isnan(values[i]) ? std::abs(values[i]) : values[i];
      throw SceneError(name, 0, fmt::format("{} is {} at {}; {}", what, shown, at_place(x, i, t, field), must));
    }
  };
  constexpr const char* smooth = "sources are made of it: write a field that has a derivative there";
  for (std::size_t k = 0; k < components; ++k) {
    check(std::span(value).subspan(k * count, count), is_vector ? fmt::format("component {} of {}", k + 1, name) : name,
          "it must be finite everywhere");
  }
  if (is_vector) return check(slopes, fmt::format("the divergence of {}", name), smooth);
  for (std::size_t k = 0; k < dimension; ++k) {
    check(std::span(slopes).subspan(k * count, count),
          fmt::format("the derivative of {} by {}", name, coordinate_names[k]), smooth);
  }
  check(by_t, fmt::format("the derivative of {} by t", name), smooth);
}

/// Fails if the field has a pole where it is largest: if a millionth of the period beside it, along one of the
/// coordinates, it is a thousand times less.
void check_bounded(const char* name, const Expression& field, const Points& x, double t,
                   const std::vector<double>& periods) {
  const std::size_t components = field.components();
  std::vector<double> values(components * x.size()), sizes(x.size(), 0.0);
  field.evaluate(x, {t}, {.value = Vectors::blocks(values, components)});
  for (std::size_t i = 0; i < values.size(); ++i) {
    double& size = sizes[i % x.size()];
    size = std::hypot(size, values[i]);
  }
  const auto top = static_cast<std::size_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  std::vector<double> place;
  for (std::size_t k = 0; k < periods.size(); ++k) place.push_back(x[k][top]);
  for (std::size_t k = 0; k < periods.size(); ++k) {
    const auto size = [&](double at) {
      std::vector<double> point = place, value(components);
      point[k] = at;
      field.evaluate(Points::blocks(point, periods.size()), {t}, {.value = Vectors::blocks(value, components)});
      double norm = 0.0;
      for (const double one : value) norm = std::hypot(norm, one);
      return norm;
    };
    // Golden-section search for the largest size in the two cells around it, down to the last digits.
    const double here = place[k], period = periods[k],
                 cell = period / static_cast<double>(starts_on_side[periods.size() - 1]);
    double left = here - cell, right = here + cell;
    while (right - left > 4e-16 * period) {
      const double part = (right - left) / (1.0 + std::numbers::phi), a = left + part, b = right - part;
      if (!(left < a && a < b && b < right)) break;
      (size(a) < size(b) ? left : right) = size(a) < size(b) ? a : b;
    }
    const double peak = size(here) > size(left) ? here : left, most = size(peak);
    constexpr double apart = 1e-6, too_much = 1e3;
    const double beside = std::max(size(peak - apart * period), size(peak + apart * period));
    if (std::isfinite(most) && most <= too_much * beside) continue;
    place[k] = peak;
    throw SceneError(
        name, 0,
        fmt::format("{} has a pole at {}: it grows to {:.3g} there, from {:.3g} at {:.1g} beside; write a field "
                    "that is bounded",
                    name, at_place(Points::blocks(place, periods.size()), 0, t, field), most, beside, apart * period));
  }
}

}  // namespace

std::string SceneText::solution() const { return u0 ? fmt::format("u0={}|f={}", *u0, f.value_or("0")) : u; }

Scene::Scene(SceneText text)
    : text_(std::move(text)),
      periods_(constants("period", text_.period, Zero::refused, text_.dimension)),
      T_(constants("T", text_.T, Zero::allowed).front()),
      c_(compile("c", text_.c, variables(text_.dimension, false), text_.dimension)) {
  const auto at_points = variables(dimension(), false), at_times = variables(dimension(), true);
  if (text_.b) {
    b_ = compile("b", *text_.b, at_points, dimension());
    check_periodic("b", *b_);
    if (is_zero(*b_, dimension())) b_.reset();
  }
  if (text_.flow) {
    if (!b_) throw SceneError("flow", 0, "a flow without b; particles stand still unless b is given");
    flow_ = compile("flow", *text_.flow, at_times, dimension());
    check_flow();
  }
  check_periodic("c", c_);
  const PointArray starts = usual_starts(periods_);
  const auto check = [&](const char* name, const Expression& field) {
    for (const double t : {0.0, 0.37 * T_, T_}) {
      check_finite(name, field, samples(periods_), t);
      check_finite(name, field, starts, t);
      check_bounded(name, field, starts, t, periods_);
      if (!field.depends_on(dimension())) break;
    }
  };
  check("c", c_);
  if (b_) check("b", *b_);
  if (!text_.u0) {
    u_ = compile("u", text_.u, at_times);
    check_periodic("u", *u_);
    check("u", *u_);
    return;
  }
  u0_ = compile("u0", *text_.u0, at_points);
  check_periodic("u0", *u0_);
  check("u0", *u0_);
  if (!text_.f) return;
  f_ = compile("f", *text_.f, at_times);
  check_periodic("f", *f_);
  check("f", *f_);
  if (is_zero(*f_, dimension())) f_.reset();
}

double Scene::volume() const {
  double volume = 1.0;
  for (const double period : periods_) volume *= period;
  return volume;
}

double Scene::solution_size(const Points& x, double t) const {
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
  const PointArray points = samples(periods_);
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
  c(points, {}, slope);
  return size * std::exp(t * largest(slope));
}

void Scene::check_periodic(const char* field, const Expression& expression) const {
  const PointArray x = samples(periods_);
  const std::size_t components = expression.components();
  std::vector<double> here(components * x.size()), there(here.size());
  for (std::size_t k = 0; k < dimension(); ++k) {
    PointArray shifted = x;
    for (std::size_t i = 0; i < x.size(); ++i) shifted(i, k) += periods_[k];
    for (const double t : {0.0, 0.37 * T_, T_}) {
      expression.evaluate(x, {t}, {.value = Vectors::blocks(here, components)});
      expression.evaluate(shifted, {t}, {.value = Vectors::blocks(there, components)});
      double scale = 0.0, gap = 0.0;
      for (std::size_t i = 0; i < here.size(); ++i) {
        for (const auto& [value, at] : {std::pair(here[i], Points(x)), std::pair(there[i], Points(shifted))}) {
          if (std::isfinite(value)) continue;
          throw SceneError(field, 0,
                           fmt::format("{} is {} at {}; it must be finite everywhere", field,
                                       std::isnan(value) ? std::abs(value) : value, place_of(at, i % x.size())));
        }
        scale = std::max(scale, std::abs(here[i]));
        gap = std::max(gap, std::abs(here[i] - there[i]));
      }
      if (!(gap <= 1e-9 * scale)) {
        throw SceneError(field, 0,
                         fmt::format("{0} is not periodic: {0}({1} + {2:.6g}) and {0}({1}) differ by {3:.3g}", field,
                                     coordinate_names[k], periods_[k], gap));
      }
    }
  }
}

void Scene::check_flow() const {
  const PointArray x = samples(periods_);
  const std::size_t d = dimension();
  std::vector<double> position(d * x.size()), speed(position.size()), b(position.size());
  for (const double t : {0.0, 0.37 * T_, T_}) {
    flow_->evaluate(x, {t}, {.value = Vectors::blocks(position, d), .by_parameter = Vectors::blocks(speed, d)});
    this->b(x, Vectors::blocks(b, d));
    // Particles may have gathered where b is small.
    double scale = 0.0, gap = 0.0;
    for (const double value : b) scale = std::max(scale, std::abs(value));
    this->b(Points::blocks(position, d), Vectors::blocks(b, d));
    for (std::size_t i = 0; i < position.size(); ++i) {
      const double from = x.coordinates[i];
      const std::size_t k = i / x.size();
      if (t == 0.0 && !(std::abs(position[i] - from) <= 1e-9 * periods_[k])) {
        throw SceneError("flow", 0,
                         fmt::format("the flow at t = 0 takes {} = {:.6g} to {:.6g}; it must leave it there",
                                     coordinate_names[k], from, position[i]));
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
    if (d > 1) continue;
    if (!std::is_sorted(position.begin(), position.end()) || !(position.back() < position.front() + period())) {
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
  for (int i = 0; i < count; ++i) x[i] = period() * i / count;
  const auto fill = [&](std::span<const double> points, std::span<double> out, std::span<double> scratch) {
    c(points, out);
    if (!standing()) b(points, scratch);
    for (std::size_t i = 0; i < points.size(); ++i) out[i] = std::abs(out[i] - (standing() ? 0.0 : scratch[i]));
  };
  fill(x, relative, b_values);
  const auto top = std::max_element(relative.begin(), relative.end());
  const double middle = x[top - relative.begin()], cell = period() / count;
  const auto negative = [&](double point) {
    double value = 0.0, scratch = 0.0;
    fill({&point, 1}, {&value, 1}, {&scratch, 1});
    return -value;
  };
  const auto [point, value] = boost::math::tools::brent_find_minima(negative, middle - cell, middle + cell, 52);
  return std::max(*top, -value);
}

Trajectories::Trajectories(const Scene& scene, std::vector<double> start) : scene_(scene), x_(std::move(start)) {
  if (scene.flow()) at_start_.emplace(*scene.flow(), Points::blocks(x_, scene.dimension()));
}

std::span<const double> Trajectories::at(double t) {
  if (t == t_) return x_;
  if (scene_.flow()) {
    at(t, 0, Vectors::blocks(x_, scene_.dimension()));
  } else {
    constexpr double tolerance = 1e-14;
    gsl_odeiv2_system system{[](double, const double x[], double dxdt[], void* flow) {
                               const auto& self = *static_cast<const Trajectories*>(flow);
                               const std::size_t d = self.scene_.dimension(), entries = self.x_.size();
                               self.scene_.b(Points::blocks({x, entries}, d), Vectors::blocks({dxdt, entries}, d));
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
