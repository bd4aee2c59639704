#include "mms/code/terms.hpp"

#include <algorithm>

namespace acstudy::code {

Function::Function(std::string name, const std::string& text, std::vector<std::string> variables)
    : name_(std::move(name)), variables_(std::move(variables)) {
  const Expression expression(text, variables_);
  for (const Expression::Node& node : expression.tape()) {
    terms_.push_back({.op = node.op, .a = node.a, .b = node.b, .constant = node.constant});
  }
  result_ = static_cast<int>(expression.result());
}

Function Function::derivative(std::string name, std::size_t variable) const {
  Function slope = *this;
  slope.name_ = std::move(name);
  std::map<int, int> known;
  slope.result_ = slope.derivative_of(result_, variable, known);
  return slope;
}

Function Function::sign(std::string name) const {
  Function sign = *this;
  sign.name_ = std::move(name);
  const int zero = sign.constant(0.0), minus = sign.constant(-1.0), plus = sign.constant(1.0);
  sign.result_ = sign.add({.a = minus, .b = plus, .choice = true, .p = result_, .q = zero});
  return sign;
}

int Function::add(const Term& term) {
  const auto same = std::find(terms_.begin(), terms_.end(), term);
  if (same != terms_.end()) return static_cast<int>(same - terms_.begin());
  terms_.push_back(term);
  return static_cast<int>(terms_.size()) - 1;
}

int Function::make(Op op, int a, int b) {
  switch (op) {
    case Op::add:
      if (is(a, 0.0)) return b;
      if (is(b, 0.0)) return a;
      break;
    case Op::subtract:
      if (is(b, 0.0)) return a;
      if (is(a, 0.0)) return make(Op::negate, b);
      break;
    case Op::multiply:
      if (is(a, 0.0) || is(b, 1.0)) return a;
      if (is(b, 0.0) || is(a, 1.0)) return b;
      if (is(a, -1.0)) return make(Op::negate, b);
      if (is(b, -1.0)) return make(Op::negate, a);
      break;
    case Op::divide:
      if (is(a, 0.0) || is(b, 1.0)) return a;
      break;
    case Op::power:
      if (is(b, 1.0)) return a;
      break;
    case Op::negate:
      if (is(a, 0.0)) return a;
      if (is(a, 1.0)) return constant(-1.0);
      break;
    default:
      break;
  }
  return add({.op = op, .a = a, .b = b});
}

int Function::derivative_of(int term, std::size_t variable, std::map<int, int>& known) {
  const Term t = terms_[term];
  if (t.op == Op::constant) return constant(0.0);
  if (t.op == Op::variable) return constant(t.a == static_cast<int>(variable) ? 1.0 : 0.0);
  if (const auto found = known.find(term); found != known.end()) return found->second;
  const int da = derivative_of(t.a, variable, known), db = derivative_of(t.b, variable, known);
  return known[term] = is(da, 0.0) && is(db, 0.0) ? da : chain_rule(term, da, db);
}

/// As `compute_derivatives` of mms/expression.cpp.
int Function::chain_rule(int v, int da, int db) {
  const int a = terms_[v].a, b = terms_[v].b;
  const auto square = [&](int of) { return make(Op::multiply, of, of); };
  const auto times_da = [&](int factor) { return make(Op::multiply, factor, da); };
  const auto over = [&](int divisor) { return make(Op::divide, da, divisor); };
  const auto one_minus_square = [&] {
    return make(Op::multiply, make(Op::subtract, constant(1.0), a), make(Op::add, constant(1.0), a));
  };
  switch (terms_[v].op) {
    case Op::constant:
    case Op::variable:
      break;
    case Op::add:
    case Op::subtract:
      return make(terms_[v].op, da, db);
    case Op::multiply:
      return make(Op::add, make(Op::multiply, da, b), make(Op::multiply, a, db));
    case Op::divide:
      return make(Op::divide, make(Op::subtract, da, make(Op::multiply, v, db)), b);
    case Op::power: {
      int slope = constant(0.0);
      if (!is(da, 0.0) && !is(b, 0.0)) {
        const bool fixed = terms_[b].op == Op::constant && !terms_[b].choice;
        const int less = fixed ? constant(terms_[b].constant - 1.0) : make(Op::subtract, b, constant(1.0));
        slope = times_da(make(Op::multiply, b, make(Op::power, a, less)));
      }
      if (is(db, 0.0)) return slope;
      return make(Op::add, slope, make(Op::multiply, make(Op::multiply, v, make(Op::log, a)), db));
    }
    case Op::negate:
      return make(Op::negate, da);
    case Op::sin:
      return times_da(make(Op::cos, a));
    case Op::cos:
      return make(Op::negate, times_da(make(Op::sin, a)));
    case Op::tan:
      return times_da(make(Op::add, constant(1.0), square(v)));
    case Op::asin:
      return over(make(Op::sqrt, one_minus_square()));
    case Op::acos:
      return make(Op::negate, over(make(Op::sqrt, one_minus_square())));
    case Op::atan:
      return over(make(Op::add, constant(1.0), square(a)));
    case Op::sinh:
      return times_da(make(Op::cosh, a));
    case Op::cosh:
      return times_da(make(Op::sinh, a));
    case Op::tanh:
      return times_da(make(Op::subtract, constant(1.0), square(v)));
    case Op::exp:
      return times_da(v);
    case Op::log:
      return over(a);
    case Op::sqrt:
      return over(make(Op::multiply, constant(2.0), v));
    case Op::abs:
      return add({.a = da, .b = make(Op::negate, da), .choice = true, .p = constant(0.0), .q = a});
    case Op::atan2:
      return make(Op::divide, make(Op::subtract, make(Op::multiply, da, b), make(Op::multiply, a, db)),
                  make(Op::add, square(a), square(b)));
    case Op::min:
      return add({.a = da, .b = db, .choice = true, .p = a, .q = b});
    case Op::max:
      return add({.a = da, .b = db, .choice = true, .p = b, .q = a});
  }
  return constant(0.0);
}

}  // namespace acstudy::code
