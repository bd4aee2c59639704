#pragma once

/// @file
/// Expressions in named variables, evaluated for many points at once, with derivatives exact to round-off.

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "mms/points.hpp"

namespace acstudy {

/// A text in quotes for a message: of one with more than 80 letters the first 60, and how many there are.
std::string in_quotes(std::string_view text);

/// A text that is no expression; `position` is the offset of the offending character.
class ExpressionError : public std::runtime_error {
 public:
  ExpressionError(std::size_t at, const std::string& message) : std::runtime_error(message), position(at) {}
  std::size_t position;
};

/// An expression such as "cos(2*x)/3".
///
/// muParser reads the text; its operators do not compute but record a tape, which is then run over blocks of points.
/// The same run propagates first derivatives (forward mode), hence exact to round-off.
/// Immutable after construction, so shared freely between threads.
class Expression {
 public:
  /// @param text       operators + - * / ^, parentheses, numbers, pi, e, and the functions of `function_names()`; at
  /// most
  ///                   `most_letters` letters
  /// @param variables  the names that may occur, at most 4: coordinates first, then what is the same at all points
  /// @param components  of a vector: so many expressions, separated by commas
  /// @throws ExpressionError
  Expression(const std::string& text, const std::vector<std::string>& variables, std::size_t components = 1);

  static constexpr std::size_t most_letters = 10'000;

  const std::string& text() const { return text_; }
  std::size_t components() const { return results_.size(); }
  bool depends_on(std::size_t variable) const { return (depends() >> variable & 1U) != 0; }
  bool is_constant() const { return depends() == 0; }

  /// The value, of a vector the first component, at one point, the variables in their declared order.
  double operator()(std::initializer_list<double> variables) const;

  /// What to compute of f(x, p) at every point x: what is not empty.
  struct Request {
    Vectors value;                 ///< f
    Vectors gradient;              ///< of a scalar f: df/dx, by each coordinate
    Vectors by_parameter;          ///< df/dp, by the first variable after the coordinates
    std::span<double> divergence;  ///< of a vector f; on a line the same as its gradient
  };

  /// Computes f at points x; the variables that are no coordinates (`rest`) are the same at all of them.
  void evaluate(const Points& x, std::initializer_list<double> rest, const Request& out) const;

  /// The operands of an expression that is factor * atan2(p, q), if it is one; of a vector the first component.
  struct Angle {
    std::size_t p, q;  ///< nodes
  };
  std::optional<Angle> angle(double factor) const;

  /// Points x that stay, with all that can be computed of an expression from x alone. Copies the points.
  class FixedPoints;

  /// The value at fixed points from number `begin` on, the variables after the coordinates given.
  void evaluate(const FixedPoints& points, std::size_t begin, std::initializer_list<double> rest,
                const Vectors& value) const;
  /// The same for the operands of an angle.
  void evaluate(const FixedPoints& points, Angle angle, std::size_t begin, std::initializer_list<double> rest,
                std::span<double> p, std::span<double> q) const;

  /// Names of the functions that an expression may call.
  static std::vector<std::string> function_names();

  enum class Op : unsigned char {
    constant,
    variable,
    add,
    subtract,
    multiply,
    divide,
    power,
    negate,
    sin,
    cos,
    tan,
    asin,
    acos,
    atan,
    sinh,
    cosh,
    tanh,
    exp,
    log,
    sqrt,
    abs,
    atan2,
    min,
    max
  };
  struct Node {
    Op op;
    int a = 0, b = 0;       ///< operands, earlier on the tape
    double constant = 0.0;  ///< value of a constant
    unsigned depends = 0;   ///< bit i: depends on variable i
  };

  /// The operations in the order in which they are done, for arithmetic of another kind; node i < number of variables
  /// is variable i.
  std::span<const Node> tape() const { return tape_; }
  /// The node of the value, of a vector that of the first component.
  std::size_t result() const { return results_.front(); }

 private:
  friend class FixedPoints;
  /// What a run has to compute at `count` points, which are `x` or those from number `begin` of fixed ones on.
  struct Task {
    std::size_t dimension, count;
    Points x = {};
    const FixedPoints* fixed = nullptr;
    std::size_t begin = 0;
    std::initializer_list<double> rest;
    std::span<const std::size_t> nodes;  ///< what is wanted of these: values,
    Request out;                         ///< and derivatives where they are those of the result
  };
  void run(const Task& task) const;
  unsigned depends() const;

  std::string text_;
  std::vector<Node> tape_;
  std::vector<std::size_t> results_;  ///< nodes of the components
};

class Expression::FixedPoints {
 public:
  FixedPoints(const Expression& expression, const Points& x);

 private:
  friend class Expression;
  std::size_t dimension_;
  std::vector<std::vector<double>> values_;  ///< of each node that depends on x alone and is used beyond that
};

}  // namespace acstudy
