#pragma once

/// @file
/// Expressions and their derivatives as terms that can be written down again, in another language.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mms/expression.hpp"

namespace acstudy::code {

/// An operation of an expression, or a choice, which derivatives of abs, min and max are.
struct Term {
  Expression::Op op = Expression::Op::constant;
  int a = 0, b = 0;       ///< operands, earlier in the list
  double constant = 0.0;  ///< value of a constant
  bool choice = false;    ///< p <= q ? a : b
  int p = 0, q = 0;
  bool operator==(const Term&) const = default;
};

/// A function of some variables, by its terms.
class Function {
 public:
  /// f itself.
  Function(std::string name, const std::string& text, std::vector<std::string> variables);

  /// df/d(variable), exact as those that runs compute, with what is zero or one left out.
  Function derivative(std::string name, std::size_t variable) const;
  /// f > 0 ? 1 : -1.
  Function sign(std::string name) const;

  const std::string& name() const { return name_; }
  const std::vector<std::string>& variables() const { return variables_; }
  const std::vector<Term>& terms() const { return terms_; }
  int result() const { return result_; }

 private:
  using Op = Expression::Op;
  int add(const Term& term);
  int constant(double value) { return add({.op = Op::constant, .constant = value}); }
  /// The operation, or what is left of it where an operand is zero or one.
  int make(Op op, int a, int b);
  int make(Op op, int a) { return make(op, a, a); }
  bool is(int term, double value) const {
    return !terms_[term].choice && terms_[term].op == Op::constant && terms_[term].constant == value;
  }
  int derivative_of(int term, std::size_t variable, std::map<int, int>& known);
  int chain_rule(int term, int da, int db);

  std::string name_;
  std::vector<std::string> variables_;
  std::vector<Term> terms_;
  int result_;
};

}  // namespace acstudy::code
