#include "mms/expression.hpp"

#include <muParser.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <numbers>

#include "mms/vector_math.hpp"

namespace acstudy {

namespace {

using Op = Expression::Op;
using Node = Expression::Node;

struct Function {
  const char* name;
  Op op;
};
constexpr Function unary_functions[] = {
    {"sin", Op::sin},   {"cos", Op::cos},   {"tan", Op::tan},   {"asin", Op::asin}, {"acos", Op::acos},
    {"atan", Op::atan}, {"sinh", Op::sinh}, {"cosh", Op::cosh}, {"tanh", Op::tanh}, {"exp", Op::exp},
    {"log", Op::log},   {"sqrt", Op::sqrt}, {"abs", Op::abs},
};
constexpr Function binary_functions[] = {{"atan2", Op::atan2}, {"min", Op::min}, {"max", Op::max}};

/// The tape being recorded. muParser's callbacks are plain functions, so they find it here; what muParser takes for the
/// value of a subexpression is the index of its node.
thread_local std::vector<Node>* recording = nullptr;

double record(Node node) {
  auto& tape = *recording;
  if (node.op != Op::constant && node.op != Op::variable) node.depends = tape[node.a].depends | tape[node.b].depends;
  const auto same = std::find_if(tape.begin(), tape.end(), [&](const Node& old) {
    return old.op == node.op && old.a == node.a && old.b == node.b &&
           std::memcmp(&old.constant, &node.constant, sizeof(double)) == 0;
  });
  if (same != tape.end()) return static_cast<double>(same - tape.begin());
  tape.push_back(node);
  return static_cast<double>(tape.size() - 1);
}

template <Op op>
double record_unary(double a) {
  return record({.op = op, .a = static_cast<int>(a), .b = static_cast<int>(a)});
}
template <Op op>
double record_binary(double a, double b) {
  return record({.op = op, .a = static_cast<int>(a), .b = static_cast<int>(b)});
}
double same_node(double a) { return a; }

/// muParser's hook for number literals.
int record_number(const char* text, int* position, double* value) {
  if (!(std::isdigit(static_cast<unsigned char>(*text)) || *text == '.')) return 0;
  double number = 0.0;
  const auto [end, error] = std::from_chars(text, text + std::strlen(text), number);
  if (error != std::errc()) {
    throw ExpressionError(static_cast<std::size_t>(*position), "a number that double precision cannot hold");
  }
  *value = record({.op = Op::constant, .constant = number});
  *position += static_cast<int>(end - text);
  return 1;
}

template <std::size_t... i>
void define_functions(mu::Parser& parser, std::index_sequence<i...>) {
  (parser.DefineFun(unary_functions[i].name, record_unary<unary_functions[i].op>, false), ...);
}

std::string explain(const mu::ParserError& error, const std::vector<std::string>& variables) {
  std::string token = error.GetToken();
  token.erase(token.find_last_not_of(' ') + 1);
  const std::string shown = in_quotes(token);
  const auto functions = Expression::function_names();
  switch (error.GetCode()) {
    case mu::ecUNASSIGNABLE_TOKEN: {
      if (std::find(functions.begin(), functions.end(), token) != functions.end()) {
        return "the function " + shown + " needs its argument in parentheses";
      }
      std::string names;
      for (const auto& name : variables) names += name + ", ";
      return "unknown name " + shown + "; it may use " + names + "pi, e and the usual functions";
    }
    case mu::ecUNEXPECTED_EOF:
      return "the expression ends too early";
    case mu::ecMISSING_PARENS:
      return "a closing parenthesis is missing";
    case mu::ecUNEXPECTED_PARENS:
      return "unexpected parenthesis " + shown;
    case mu::ecUNEXPECTED_OPERATOR:
      return "unexpected operator " + shown;
    case mu::ecUNEXPECTED_VAL:
    case mu::ecUNEXPECTED_VAR:
      return "unexpected value " + shown + "; an operator is missing before it";
    case mu::ecUNEXPECTED_FUN:
      return "unexpected function " + shown + "; an operator is missing before it";
    case mu::ecUNEXPECTED_ARG_SEP:
      return "unexpected comma";
    case mu::ecTOO_MANY_PARAMS:
      return "too many arguments for " + shown;
    case mu::ecTOO_FEW_PARAMS:
      return "too few arguments for " + shown;
    case mu::ecEMPTY_EXPRESSION:
      return "the expression is empty";
    default:
      return "syntax error near " + shown;
  }
}

}  // namespace

std::string in_quotes(std::string_view text) {
  constexpr std::size_t whole = 80;
  std::size_t shown = 60;
  if (text.size() <= whole) return "\"" + std::string(text) + "\"";
  while (shown > 0 && (static_cast<unsigned char>(text[shown]) & 0xC0U) == 0x80U) --shown;  // no part of a UTF-8 letter
  return "\"" + std::string(text.substr(0, shown)) + "...\" (" + std::to_string(text.size()) + " letters)";
}

std::vector<std::string> Expression::function_names() {
  std::vector<std::string> names;
  for (const auto& function : unary_functions) names.emplace_back(function.name);
  for (const auto& function : binary_functions) names.emplace_back(function.name);
  return names;
}

Expression::Expression(const std::string& text, const std::vector<std::string>& variables, std::size_t components)
    : text_(text) {
  if (text.find_first_not_of(" \t\n\r") == std::string::npos) throw ExpressionError(0, "the expression is empty");
  if (text.size() > most_letters) {
    throw ExpressionError(0, "the expression " + in_quotes(text) + " is too long; the most is " +
                                 std::to_string(most_letters) + " letters: write a shorter one");
  }
  if (const auto at = text.find_first_of("?:=<>!&|,;"); at != std::string::npos && text[at] != ',') {
    throw ExpressionError(at, std::string("unexpected \"") + text[at] + "\"; an expression has no conditions");
  }
  if (const auto at = text.find("**"); at != std::string::npos) {
    throw ExpressionError(at, "unexpected \"**\"; write h^2 for a power");
  }
  recording = &tape_;
  for (std::size_t i = 0; i < variables.size(); ++i)
    tape_.push_back({.op = Op::variable, .a = int(i), .depends = 1U << i});
  try {
    mu::Parser parser;
    parser.EnableBuiltInOprt(false);
    parser.EnableOptimizer(false);
    parser.ClearFun();
    parser.ClearConst();
    parser.ClearInfixOprt();
    parser.DefineOprt("+", record_binary<Op::add>, mu::prADD_SUB);
    parser.DefineOprt("-", record_binary<Op::subtract>, mu::prADD_SUB);
    parser.DefineOprt("*", record_binary<Op::multiply>, mu::prMUL_DIV);
    parser.DefineOprt("/", record_binary<Op::divide>, mu::prMUL_DIV);
    parser.DefineOprt("^", record_binary<Op::power>, mu::prPOW, mu::oaRIGHT);
    parser.DefineInfixOprt("-", record_unary<Op::negate>, mu::prINFIX, false);
    parser.DefineInfixOprt("+", same_node, mu::prINFIX, false);
    define_functions(parser, std::make_index_sequence<std::size(unary_functions)>{});
    parser.DefineFun("atan2", record_binary<Op::atan2>, false);
    parser.DefineFun("min", record_binary<Op::min>, false);
    parser.DefineFun("max", record_binary<Op::max>, false);
    parser.AddValIdent(record_number);
    parser.DefineConst("pi", record({.op = Op::constant, .constant = std::numbers::pi}));
    parser.DefineConst("e", record({.op = Op::constant, .constant = std::numbers::e}));
    for (std::size_t i = 0; i < variables.size(); ++i) parser.DefineConst(variables[i], static_cast<double>(i));
    parser.SetExpr(text);
    int results = 0;
    const double* values = parser.Eval(results);
    const auto count = static_cast<std::size_t>(results);
    if (count > components) throw ExpressionError(text.find(','), "unexpected comma");
    if (count < components) {
      throw ExpressionError(0, "a vector needs " + std::to_string(components) + " components, separated by commas");
    }
    results_.assign(values, values + count);
  } catch (const mu::ParserError& error) {
    const int position = error.GetPos();
    const auto last = static_cast<int>(text.size()) - 1;
    throw ExpressionError(static_cast<std::size_t>(std::clamp(position, 0, last)), explain(error, variables));
  }
}

namespace {

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
       .values = value});
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
       .values = {p, q}});
}

void Expression::evaluate(const Points& x, std::initializer_list<double> rest, const Request& out) const {
  run({.dimension = x.dimension(),
       .count = x.size(),
       .x = x,
       .rest = rest,
       .nodes = results_,
       .values = out.value,
       .gradient = out.gradient,
       .by_parameter = out.by_parameter,
       .divergence = out.divergence});
}

void Expression::run(const Task& task) const {
  thread_local Workspace workspace;
  const std::size_t dimension = task.dimension;
  const unsigned of_points = coordinates(dimension);
  // Derivatives that are wanted: those by the directions `first` to `last`.
  const bool by_coordinates = !task.gradient.empty() || !task.divergence.empty();
  const std::size_t first = by_coordinates ? 0 : dimension, last = dimension + (task.by_parameter.empty() ? 0 : 1);
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
    for (std::size_t k = 0; k < task.values.dimension(); ++k) {
      if (!task.values.empty()) std::copy_n(at[task.nodes[k]], here, task.values[k].begin() + begin);
    }
    for (std::size_t v = 0; v < task.gradient.dimension() && !task.gradient.empty(); ++v) {
      std::copy_n(by[v][task.nodes[0]].begin(), here, task.gradient[v].begin() + begin);
    }
    for (std::size_t k = 0; k < task.by_parameter.dimension() && !task.by_parameter.empty(); ++k) {
      std::copy_n(by[dimension][task.nodes[k]].begin(), here, task.by_parameter[k].begin() + begin);
    }
    for (std::size_t v = 0; v < dimension && !task.divergence.empty(); ++v) {
      const Block& slope = by[v][task.nodes[v]];
      double* const out = task.divergence.data() + begin;
      for (std::size_t j = 0; j < here; ++j) out[j] = v == 0 ? slope[j] : out[j] + slope[j];
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
