#include "studies/models/exact_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <numbers>

namespace acstudy {

namespace {

/// A value and its derivative by s.
struct Dual {
  HundredDigits value, slope;
};

Dual constant(double number) {
  if (number == std::numbers::pi) return {boost::math::constants::pi<HundredDigits>(), 0};
  if (number == std::numbers::e) return {boost::math::constants::e<HundredDigits>(), 0};
  return {number, 0};
}

Dual power(const Dual& a, const Dual& b) {
  if (b.slope != 0) {
    const HundredDigits value = pow(a.value, b.value);
    return {value, value * (b.slope * log(a.value) + b.value * a.slope / a.value)};
  }
  const auto to_the = [&](const HundredDigits& exponent) -> HundredDigits {
    return exponent == trunc(exponent) && abs(exponent) < 1000 ? pow(a.value, static_cast<int>(exponent))
                                                               : pow(a.value, exponent);
  };
  return {to_the(b.value),
          b.value == 0 || a.slope == 0 ? HundredDigits(0) : HundredDigits(b.value * to_the(b.value - 1) * a.slope)};
}

/// An operation of an expression, b with one operand being the same as a.
Dual apply(Expression::Op op, const Dual& a, const Dual& b) {
  using Op = Expression::Op;
  const HundredDigits& x = a.value;
  const auto chain = [&](const HundredDigits& value, const HundredDigits& slope) {
    return Dual{value, slope * a.slope};
  };
  switch (op) {
    case Op::constant:
    case Op::variable:
      break;
    case Op::add:
      return {x + b.value, a.slope + b.slope};
    case Op::subtract:
      return {x - b.value, a.slope - b.slope};
    case Op::multiply:
      return {x * b.value, a.slope * b.value + x * b.slope};
    case Op::divide:
      return {x / b.value, (a.slope - x / b.value * b.slope) / b.value};
    case Op::power:
      return power(a, b);
    case Op::negate:
      return {-x, -a.slope};
    case Op::sin:
      return chain(sin(x), cos(x));
    case Op::cos:
      return chain(cos(x), -sin(x));
    case Op::tan:
      return chain(tan(x), 1 + tan(x) * tan(x));
    case Op::asin:
      return chain(asin(x), 1 / sqrt(HundredDigits(1 - x * x)));
    case Op::acos:
      return chain(acos(x), -1 / sqrt(HundredDigits(1 - x * x)));
    case Op::atan:
      return chain(atan(x), 1 / (1 + x * x));
    case Op::sinh:
      return chain(sinh(x), cosh(x));
    case Op::cosh:
      return chain(cosh(x), sinh(x));
    case Op::tanh:
      return chain(tanh(x), 1 - tanh(x) * tanh(x));
    case Op::exp:
      return chain(exp(x), exp(x));
    case Op::log:
      return chain(log(x), 1 / x);
    case Op::sqrt:
      return chain(sqrt(x), 1 / (2 * sqrt(x)));
    case Op::abs:
      return x < 0 ? Dual{-x, -a.slope} : a;
    case Op::atan2:
      return {atan2(x, b.value), (a.slope * b.value - x * b.slope) / (x * x + b.value * b.value)};
    case Op::min:
      return b.value < x ? b : a;
    case Op::max:
      return b.value > x ? b : a;
  }
  return constant(0.0);
}

Dual evaluate(const Expression& expression, const HundredDigits& s) {
  std::vector<Dual> values;
  for (const Expression::Node& node : expression.tape()) {
    if (node.op == Expression::Op::variable)
      values.push_back({s, 1});
    else if (node.op == Expression::Op::constant)
      values.push_back(constant(node.constant));
    else
      values.push_back(apply(node.op, values[node.a], values[node.b]));
  }
  return values[expression.result()];
}

Expression parse(const std::string& key, const std::string& text, const std::vector<std::string>& variables,
                 std::size_t entry = 0) {
  try {
    return {text, variables};
  } catch (const ExpressionError& error) {
    throw KernelError(key, fmt::format("{} = {}: {}", key, in_quotes(text), error.what()), error.position, entry);
  }
}

}  // namespace

ExactProfile::ExactProfile(KernelFormula formula)
    : formula_(std::move(formula)), expression_(parse(formula_.key(), formula_.text, {"s"})), ends_{0.0} {
  for (std::size_t k = 0; k < formula_.breaks.size(); ++k) {
    const double point = static_cast<double>(evaluate(parse("breaks", formula_.breaks[k], {}, k), 0).value);
    if (!(point > ends_.back() && point < 1.0)) {
      throw KernelError(
          "breaks",
          fmt::format("breaks contains {}; they are points between 0 and 1 in increasing order", formula_.breaks[k]), 0,
          k);
    }
    ends_.push_back(point);
  }
  ends_.push_back(1.0);
}

HundredDigits ExactProfile::regular_part(const HundredDigits& s) const {
  const Dual at_s = evaluate(expression_, s);
  return formula_.density ? HundredDigits(-at_s.slope) : at_s.value;
}

HundredDigits ExactProfile::eta(const HundredDigits& s) const {
  return formula_.exponent == 0.0 ? regular_part(s)
                                  : HundredDigits(regular_part(s) * pow(s, HundredDigits(-formula_.exponent)));
}

HundredDigits ExactProfile::integral(int power, const HundredDigits& from, const HundredDigits& to) const {
  const auto smooth = [&](const HundredDigits& a, const HundredDigits& b) {
    const auto integrand = [&](const HundredDigits& s) { return power == 0 ? eta(s) : HundredDigits(s * eta(s)); };
    using boost::math::quadrature::gauss;
    return b - a < 1e-3 ? gauss<HundredDigits, 7>::integrate(integrand, a, b)
                        : gauss<HundredDigits, 15>::integrate(integrand, a, b);
  };
  HundredDigits sum = 0;
  for (std::size_t k = 0; k + 1 < ends_.size(); ++k) {
    const HundredDigits begin = std::max(from, HundredDigits(ends_[k]));
    HundredDigits end = std::min(to, HundredDigits(ends_[k + 1]));
    if (!(begin < end)) continue;
    if (formula_.exponent == 0.0 || k > 0) {
      const int parts = end - begin > 0.125 ? 8 : 1;
      for (int i = 0; i < parts; ++i) {
        sum += smooth(begin + (end - begin) * i / parts, begin + (end - begin) * (i + 1) / parts);
      }
      continue;
    }
    // By octaves down to where nothing but the power is left of the singularity at 0.
    for (int octave = 0; end > 2 * begin && octave < 50; ++octave, end /= 2) sum += smooth(end / 2, end);
    const HundredDigits p = power + 1 - HundredDigits(formula_.exponent);
    sum += begin == 0 ? HundredDigits(regular_part(end / 2) * pow(end, p) / p) : smooth(begin, end);
  }
  return sum;
}

}  // namespace acstudy
