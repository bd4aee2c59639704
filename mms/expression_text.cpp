/// @file
/// Expressions: from a text to a tape.

#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>
#include <numbers>

#include "mms/expression.hpp"

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

}  // namespace acstudy
