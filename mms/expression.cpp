/// @file
/// Expressions: a tape run over points.

#include "mms/expression.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mms/vector_math.hpp"

namespace acstudy {

namespace {

using Op = Expression::Op;
using Node = Expression::Node;

constexpr std::size_t block_size = 128;
using Block = std::array<double, block_size>;

constexpr std::size_t most_directions = most_dimensions + 1;

/// Values and requested derivatives of every node for one block of points.
struct Workspace {
  std::vector<Block> value;
  std::array<std::vector<Block>, most_directions> by;  ///< each coordinate, and the parameter after them
  std::vector<const double*> at;                       ///< where the values of each node are: here or with fixed points
};

ACSTUDY_VECTOR_CLONES void compute_values(const Node& node, const std::vector<const double*>& at, double* v,
                                          std::size_t n) {
  const double *const a = at[node.a], *const b = at[node.b];
  const auto each = [&](auto&& f) {
    for (std::size_t i = 0; i < n; ++i) v[i] = f(i);
  };
  switch (node.op) {
    case Op::constant:
    case Op::variable:
      break;
    case Op::add:
      return each([&](auto i) { return a[i] + b[i]; });
    case Op::subtract:
      return each([&](auto i) { return a[i] - b[i]; });
    case Op::multiply:
      return each([&](auto i) { return a[i] * b[i]; });
    case Op::divide:
      return each([&](auto i) { return a[i] / b[i]; });
    case Op::power:
      return each([&](auto i) { return b[i] == 2.0 ? a[i] * a[i] : std::pow(a[i], b[i]); });
    case Op::negate:
      return each([&](auto i) { return -a[i]; });
    case Op::sin:
      return each([&](auto i) { return std::sin(a[i]); });
    case Op::cos:
      return each([&](auto i) { return std::cos(a[i]); });
    case Op::tan:
      return each([&](auto i) { return std::tan(a[i]); });
    case Op::asin:
      return each([&](auto i) { return std::asin(a[i]); });
    case Op::acos:
      return each([&](auto i) { return std::acos(a[i]); });
    case Op::atan:
      return each([&](auto i) { return std::atan(a[i]); });
    case Op::sinh:
      return each([&](auto i) { return std::sinh(a[i]); });
    case Op::cosh:
      return each([&](auto i) { return std::cosh(a[i]); });
    case Op::tanh:
      return each([&](auto i) { return std::tanh(a[i]); });
    case Op::exp:
      return each([&](auto i) { return std::exp(a[i]); });
    case Op::log:
      return each([&](auto i) { return std::log(a[i]); });
    case Op::sqrt:
      return each([&](auto i) { return std::sqrt(a[i]); });
    case Op::abs:
      return each([&](auto i) { return std::abs(a[i]); });
    case Op::atan2:
      return each([&](auto i) { return std::atan2(a[i], b[i]); });
    case Op::min:
      return each([&](auto i) { return std::min(a[i], b[i]); });
    case Op::max:
      return each([&](auto i) { return std::max(a[i], b[i]); });
  }
}

/// d = derivative of the node, from the derivatives of its operands; the values are already there. A constant operand
/// is skipped rather than multiplied by zero, so that x^2 at x = 0 never meets log(0).
ACSTUDY_VECTOR_CLONES void compute_derivatives(const Node& node, const std::vector<Node>& tape, unsigned direction,
                                               const std::vector<const double*>& at,
                                               const std::vector<Block>& derivative, const double* v, Block& d,
                                               std::size_t n) {
  const double *const a = at[node.a], *const b = at[node.b];
  const Block &da = derivative[node.a], &db = derivative[node.b];
  const bool varies_a = (tape[node.a].depends & direction) != 0, varies_b = (tape[node.b].depends & direction) != 0;
  const auto each = [&](auto&& f) {
    for (std::size_t i = 0; i < n; ++i) d[i] = f(i);
  };
  switch (node.op) {
    case Op::constant:
    case Op::variable:
      break;
    case Op::add:
      return each([&](auto i) { return da[i] + db[i]; });
    case Op::subtract:
      return each([&](auto i) { return da[i] - db[i]; });
    case Op::multiply:
      return each([&](auto i) { return da[i] * b[i] + a[i] * db[i]; });
    case Op::divide:
      return each([&](auto i) { return (da[i] - v[i] * db[i]) / b[i]; });
    case Op::power:
      return each([&](auto i) {
        const double base =
            varies_a && b[i] != 0.0 ? b[i] * (b[i] == 2.0 ? a[i] : std::pow(a[i], b[i] - 1.0)) * da[i] : 0.0;
        return varies_b ? base + v[i] * std::log(a[i]) * db[i] : base;
      });
    case Op::negate:
      return each([&](auto i) { return -da[i]; });
    case Op::sin:
      return each([&](auto i) { return std::cos(a[i]) * da[i]; });
    case Op::cos:
      return each([&](auto i) { return -std::sin(a[i]) * da[i]; });
    case Op::tan:
      return each([&](auto i) { return (1.0 + v[i] * v[i]) * da[i]; });
    case Op::asin:
      return each([&](auto i) { return da[i] / std::sqrt((1.0 - a[i]) * (1.0 + a[i])); });
    case Op::acos:
      return each([&](auto i) { return -da[i] / std::sqrt((1.0 - a[i]) * (1.0 + a[i])); });
    case Op::atan:
      return each([&](auto i) { return da[i] / (1.0 + a[i] * a[i]); });
    case Op::sinh:
      return each([&](auto i) { return std::cosh(a[i]) * da[i]; });
    case Op::cosh:
      return each([&](auto i) { return std::sinh(a[i]) * da[i]; });
    case Op::tanh:
      return each([&](auto i) { return (1.0 - v[i] * v[i]) * da[i]; });
    case Op::exp:
      return each([&](auto i) { return v[i] * da[i]; });
    case Op::log:
      return each([&](auto i) { return da[i] / a[i]; });
    case Op::sqrt:
      return each([&](auto i) { return 0.5 * da[i] / v[i]; });
    case Op::abs:
      return each([&](auto i) { return a[i] < 0.0 ? -da[i] : da[i]; });
    case Op::atan2:
      return each([&](auto i) { return (da[i] * b[i] - a[i] * db[i]) / (a[i] * a[i] + b[i] * b[i]); });
    case Op::min:
      return each([&](auto i) { return a[i] <= b[i] ? da[i] : db[i]; });
    case Op::max:
      return each([&](auto i) { return a[i] >= b[i] ? da[i] : db[i]; });
  }
}

}  // namespace

namespace {

/// The bits of Node::depends that stand for coordinates.
unsigned coordinates(std::size_t dimension) { return (1U << dimension) - 1U; }
bool of_points_alone(const Node& node, std::size_t dimension) {
  return node.depends != 0 && (node.depends & ~coordinates(dimension)) == 0;
}

}  // namespace

Expression::FixedPoints::FixedPoints(const Expression& expression, const Points& x)
    : dimension_(x.dimension()), values_(expression.tape_.size()) {
  std::vector<bool> needed(expression.tape_.size());
  std::size_t nodes = 0;
  for (const std::size_t result : expression.results_) {
    needed[result] = true;
    nodes = std::max(nodes, result + 1);
  }
  for (std::size_t i = 0; i < nodes; ++i) {
    const Node& node = expression.tape_[i];
    if ((node.depends & ~coordinates(dimension_)) == 0 || node.op == Op::variable) continue;
    needed[node.a] = needed[node.b] = true;
  }
  Expression part = expression;
  for (std::size_t i = 0; i < needed.size(); ++i) {
    if (!needed[i] || !of_points_alone(expression.tape_[i], dimension_)) continue;
    values_[i].resize(x.size());
    part.results_ = {i};
    part.evaluate(x, {}, {.value = values_[i]});
  }
}

void Expression::evaluate(const FixedPoints& points, std::size_t begin, std::initializer_list<double> rest,
                          const Vectors& value) const {
  run({.dimension = points.dimension_,
       .count = value.size(),
       .fixed = &points,
       .begin = begin,
       .rest = rest,
       .nodes = results_,
       .out = {.value = value}});
}

void Expression::evaluate(const FixedPoints& points, Angle angle, std::size_t begin, std::initializer_list<double> rest,
                          std::span<double> p, std::span<double> q) const {
  const std::size_t nodes[] = {angle.p, angle.q};
  run({.dimension = points.dimension_,
       .count = p.size(),
       .fixed = &points,
       .begin = begin,
       .rest = rest,
       .nodes = nodes,
       .out = {.value = {p, q}}});
}

void Expression::evaluate(const Points& x, std::initializer_list<double> rest, const Request& out) const {
  run({.dimension = x.dimension(), .count = x.size(), .x = x, .rest = rest, .nodes = results_, .out = out});
}

void Expression::run(const Task& task) const {
  thread_local Workspace workspace;
  const std::size_t dimension = task.dimension;
  const Request& out = task.out;
  const unsigned of_points = coordinates(dimension);
  // Derivatives that are wanted: those by the directions `first` to `last`.
  const bool by_coordinates = !out.gradient.empty() || !out.divergence.empty();
  const std::size_t first = by_coordinates ? 0 : dimension, last = dimension + (out.by_parameter.empty() ? 0 : 1);
  const std::size_t nodes = *std::max_element(task.nodes.begin(), task.nodes.end()) + 1;
  if (workspace.value.size() < nodes) workspace.value.resize(nodes);
  for (std::size_t v = first; v < last; ++v) {
    if (workspace.by[v].size() < nodes) workspace.by[v].resize(nodes);
  }
  if (workspace.at.size() < nodes) workspace.at.resize(nodes);
  auto& value = workspace.value;
  auto& by = workspace.by;
  auto& at = workspace.at;

  // Of blocks only what is used is filled: a source is computed at a few samples in every step.
  const std::size_t width = std::min(block_size, (task.count + vector_width - 1) / vector_width * vector_width);
  const auto fill = [width](Block& block, double with) { std::fill_n(block.begin(), width, with); };
  const auto derive = [&](std::size_t i, std::size_t v, std::size_t n) {
    const Node& node = tape_[i];
    if ((node.depends >> v & 1U) == 0) {
      fill(by[v][i], 0.0);
    } else if (node.op == Op::variable) {
      fill(by[v][i], 1.0);
    } else {
      compute_derivatives(node, tape_, 1U << v, at, by[v], at[i], by[v][i], n);
    }
  };
  const auto spread = [&](Block& block) { fill(block, block[0]); };

  // Nodes that do not depend on the point once per call, the others once per block of points.
  for (std::size_t i = 0; i < nodes; ++i) {
    const Node& node = tape_[i];
    at[i] = value[i].data();
    if (node.depends & of_points) {
      for (std::size_t v = first; v < last && node.op == Op::variable; ++v) derive(i, v, vector_width);
      continue;
    }
    if (node.op == Op::constant) fill(value[i], node.constant);
    if (node.op == Op::variable && node.a - dimension < task.rest.size()) {
      fill(value[i], *(task.rest.begin() + (node.a - dimension)));
    }
    compute_values(node, at, value[i].data(), vector_width);
    spread(value[i]);
    for (std::size_t v = first; v < last; ++v) {
      derive(i, v, vector_width);
      if (v == dimension) spread(by[v][i]);
    }
  }

  for (std::size_t begin = 0; begin < task.count; begin += block_size) {
    const std::size_t here = std::min(block_size, task.count - begin);
    // Whole vectors only: a remainder in scalar arithmetic would make f(x) depend on where in the array x stands.
    const std::size_t n = (here + vector_width - 1) / vector_width * vector_width;
    const auto known = [&](std::size_t i, const double* values) {
      at[i] = values;
      if (here == n) return;
      std::copy_n(values, here, value[i].begin());
      std::fill(value[i].begin() + here, value[i].begin() + n, values[0]);
      at[i] = value[i].data();
    };
    for (std::size_t i = 0; i < nodes; ++i) {
      const Node& node = tape_[i];
      if ((node.depends & of_points) == 0) continue;
      if (task.fixed != nullptr && of_points_alone(node, dimension)) {
        const std::vector<double>& values = task.fixed->values_[i];
        if (!values.empty()) known(i, values.data() + task.begin + begin);
      } else if (node.op == Op::variable) {
        known(i, task.x[node.a].data() + begin);
      } else {
        compute_values(node, at, value[i].data(), n);
        for (std::size_t v = first; v < last; ++v) derive(i, v, n);
      }
    }
    for (std::size_t k = 0; k < out.value.dimension(); ++k) {
      if (!out.value.empty()) std::copy_n(at[task.nodes[k]], here, out.value[k].begin() + begin);
    }
    for (std::size_t v = 0; v < out.gradient.dimension() && !out.gradient.empty(); ++v) {
      std::copy_n(by[v][task.nodes[0]].begin(), here, out.gradient[v].begin() + begin);
    }
    for (std::size_t k = 0; k < out.by_parameter.dimension() && !out.by_parameter.empty(); ++k) {
      std::copy_n(by[dimension][task.nodes[k]].begin(), here, out.by_parameter[k].begin() + begin);
    }
    for (std::size_t v = 0; v < dimension && !out.divergence.empty(); ++v) {
      const Block& slope = by[v][task.nodes[v]];
      double* const sum = out.divergence.data() + begin;
      for (std::size_t j = 0; j < here; ++j) sum[j] = v == 0 ? slope[j] : sum[j] + slope[j];
    }
  }
}

unsigned Expression::depends() const {
  unsigned depends = 0;
  for (const std::size_t result : results_) depends |= tape_[result].depends;
  return depends;
}

std::optional<Expression::Angle> Expression::angle(double factor) const {
  std::size_t i = results_.front();
  const auto constant = [&](int node) { return tape_[node].op == Op::constant; };
  for (;;) {
    const Node& node = tape_[i];
    if (node.op == Op::multiply && constant(node.a)) {
      factor /= tape_[node.a].constant;
      i = node.b;
    } else if (node.op == Op::multiply && constant(node.b)) {
      factor /= tape_[node.b].constant;
      i = node.a;
    } else if (node.op == Op::divide && constant(node.b)) {
      factor *= tape_[node.b].constant;
      i = node.a;
    } else {
      break;
    }
  }
  const Node& node = tape_[i];
  // Of what depends on x alone, points that are fixed keep the value and not the operands.
  if (node.op != Op::atan2 || node.depends <= 1U || !(std::abs(factor - 1.0) <= 1e-15)) return std::nullopt;
  return Angle{static_cast<std::size_t>(node.a), static_cast<std::size_t>(node.b)};
}

double Expression::operator()(std::initializer_list<double> variables) const {
  double values[4] = {0.0, 0.0, 0.0, 0.0}, value = 0.0;
  std::copy(variables.begin(), variables.end(), values);
  evaluate({values, 1}, {values[1], values[2], values[3]}, {.value = {&value, 1}});
  // The sign of a NaN says nothing and differs between processors.
  return std::isnan(value) ? std::abs(value) : value;
}

}  // namespace acstudy
