#pragma once

/// @file
/// How other languages write functions of numbers.

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mms/expression.hpp"
#include "mms/quadrature.hpp"

namespace acstudy::code {

/// A statement: name = value, or name = name + value.
struct Statement {
  std::string name, value;
  bool adds = false;
};

/// A sum over the nodes of a quadrature rule. Its statements may say `node` and `weight` of the rule by `entry`.
struct Sum {
  std::string rule;  ///< names its arrays: "node" with "gauss_node"
  Rule points;
  std::vector<Statement> each;
};

/// A function that is to be written: its statements, then its sums, then its value.
struct Body {
  std::string name;
  std::vector<std::string> arguments;
  std::vector<Statement> first;
  std::vector<Sum> sums;
  std::string value;
};

/// A file of constants, rules and functions.
struct Program {
  std::vector<std::string> about;  ///< lines of the comment at its top
  std::vector<std::pair<std::string, double>> constants;
  std::vector<Body> functions;  ///< each uses earlier ones alone
};

class Language {
 public:
  virtual ~Language() = default;
  virtual std::string_view name() const = 0;

  /// Shortest text that reads as the same double.
  virtual std::string number(double value) const;
  /// Of an operation that is a function call in every language.
  virtual std::string function(Expression::Op op) const = 0;
  virtual std::string power(const std::string& base, const std::string& exponent) const = 0;
  /// p <= q ? a : b
  virtual std::string choice(const std::string& p, const std::string& q, const std::string& a,
                             const std::string& b) const = 0;
  /// A function or a constant of the file, where it is used.
  virtual std::string own(const std::string& name) const { return name; }
  /// The entry of an array of a rule that a sum is at: entry("gauss", "node").
  virtual std::string entry(const std::string& rule, std::string_view array) const = 0;

  /// The file.
  virtual std::string write(const Program& program) const = 0;
};

/// Python (with NumPy), C, Fortran, Julia, JSON; null if it is none.
const Language* find_language(std::string_view name);
std::vector<std::string> language_names();

}  // namespace acstudy::code
