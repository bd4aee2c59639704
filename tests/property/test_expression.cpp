#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "mms/expression.hpp"
#include "tests/catch.hpp"

using namespace acstudy;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double pi = std::numbers::pi, e = std::numbers::e;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Values {
  std::vector<double> value, by_x, by_t;
};

Values values_of(const Expression& f, const std::vector<double>& x, double t) {
  Values s{std::vector<double>(x.size()), std::vector<double>(x.size()), std::vector<double>(x.size())};
  f.evaluate(x, {t}, {s.value, s.by_x, s.by_t});
  return s;
}

std::vector<double> random_points(std::size_t count, double low, double high) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(low, high);
  std::vector<double> x(count);
  for (double& value : x) value = uniform(generator);
  return x;
}

/// Distance in units in the last place.
double ulps(double a, double b) { return std::abs(a - b) / (std::nextafter(std::abs(b), infinity) - std::abs(b)); }

using Function = std::function<double(double, double)>;
struct Known {
  std::string text;
  Function f, f_x, f_t;
  double low = -3.0, high = 3.0;  ///< range of x
};

const Function zero = [](double, double) { return 0.0; };

/// Every operator and function, derivatives by hand.
const std::vector<Known>& known() {
  static const std::vector<Known> table = {
      {"x + 2*t", [](double x, double t) { return x + 2 * t; }, [](double, double) { return 1.0; },
       [](double, double) { return 2.0; }},
      {"x - x*t", [](double x, double t) { return x - x * t; }, [](double, double t) { return 1 - t; },
       [](double x, double) { return -x; }},
      {"x*t*x", [](double x, double t) { return x * t * x; }, [](double x, double t) { return 2 * x * t; },
       [](double x, double) { return x * x; }},
      {"t/(4 + x)", [](double x, double t) { return t / (4 + x); },
       [](double x, double t) { return -t / ((4 + x) * (4 + x)); }, [](double x, double) { return 1 / (4 + x); }},
      {"-x^2", [](double x, double) { return -x * x; }, [](double x, double) { return -2 * x; }, zero},
      {"x^3", [](double x, double) { return x * x * x; }, [](double x, double) { return 3 * x * x; }, zero},
      {"2^x", [](double x, double) { return std::exp2(x); },
       [](double x, double) { return std::exp2(x) * std::numbers::ln2; }, zero},
      {"x^x", [](double x, double) { return std::pow(x, x); },
       [](double x, double) { return std::pow(x, x) * (std::log(x) + 1); }, zero, 0.1, 3.0},
      {"x^t", [](double x, double t) { return std::pow(x, t); },
       [](double x, double t) { return t * std::pow(x, t - 1); },
       [](double x, double t) { return std::pow(x, t) * std::log(x); }, 0.1, 3.0},
      {"x^(-2)", [](double x, double) { return 1 / (x * x); }, [](double x, double) { return -2 / (x * x * x); }, zero,
       0.1, 3.0},
      {"sin(2*x - t)", [](double x, double t) { return std::sin(2 * x - t); },
       [](double x, double t) { return 2 * std::cos(2 * x - t); },
       [](double x, double t) { return -std::cos(2 * x - t); }},
      {"cos(x*t)", [](double x, double t) { return std::cos(x * t); },
       [](double x, double t) { return -t * std::sin(x * t); },
       [](double x, double t) { return -x * std::sin(x * t); }},
      {"tan(x)", [](double x, double) { return std::tan(x); },
       [](double x, double) { return 1 / (std::cos(x) * std::cos(x)); }, zero, -1.4, 1.4},
      {"asin(x)", [](double x, double) { return std::asin(x); },
       [](double x, double) { return 1 / std::sqrt(1 - x * x); }, zero, -0.9, 0.9},
      {"acos(x)", [](double x, double) { return std::acos(x); },
       [](double x, double) { return -1 / std::sqrt(1 - x * x); }, zero, -0.9, 0.9},
      {"atan(x*t)", [](double x, double t) { return std::atan(x * t); },
       [](double x, double t) { return t / (1 + x * x * t * t); },
       [](double x, double t) { return x / (1 + x * x * t * t); }},
      {"sinh(x)", [](double x, double) { return std::sinh(x); }, [](double x, double) { return std::cosh(x); }, zero},
      {"cosh(x)", [](double x, double) { return std::cosh(x); }, [](double x, double) { return std::sinh(x); }, zero},
      {"tanh(x)", [](double x, double) { return std::tanh(x); },
       [](double x, double) { return 1 / (std::cosh(x) * std::cosh(x)); }, zero},
      {"exp(-x*t)", [](double x, double t) { return std::exp(-x * t); },
       [](double x, double t) { return -t * std::exp(-x * t); },
       [](double x, double t) { return -x * std::exp(-x * t); }},
      {"log(x + t)", [](double x, double t) { return std::log(x + t); }, [](double x, double t) { return 1 / (x + t); },
       [](double x, double t) { return 1 / (x + t); }, 0.1, 3.0},
      {"sqrt(x)", [](double x, double) { return std::sqrt(x); }, [](double x, double) { return 0.5 / std::sqrt(x); },
       zero, 0.1, 3.0},
      {"abs(x)", [](double x, double) { return std::abs(x); }, [](double x, double) { return x < 0 ? -1.0 : 1.0; },
       zero},
      {"min(x, t)", [](double x, double t) { return std::min(x, t); },
       [](double x, double t) { return x <= t ? 1.0 : 0.0; }, [](double x, double t) { return x <= t ? 0.0 : 1.0; }},
      {"max(x^2, t)", [](double x, double t) { return std::max(x * x, t); },
       [](double x, double t) { return x * x >= t ? 2 * x : 0.0; },
       [](double x, double t) { return x * x >= t ? 0.0 : 1.0; }},
      {"atan2(sin(x), cos(x)*t)", [](double x, double t) { return std::atan2(std::sin(x), std::cos(x) * t); },
       [](double x, double t) { return t / (std::pow(std::sin(x), 2) + std::pow(std::cos(x) * t, 2)); },
       [](double x, double t) {
         return -std::sin(x) * std::cos(x) / (std::pow(std::sin(x), 2) + std::pow(std::cos(x) * t, 2));
       }},
      {"exp(sin(x))*cos(t)/(2 + x^2)",
       [](double x, double t) { return std::exp(std::sin(x)) * std::cos(t) / (2 + x * x); },
       [](double x, double t) {
         const double q = 2 + x * x;
         return std::exp(std::sin(x)) * std::cos(t) * (std::cos(x) * q - 2 * x) / (q * q);
       },
       [](double x, double t) { return -std::exp(std::sin(x)) * std::sin(t) / (2 + x * x); }},
      {"t", [](double, double t) { return t; }, zero, [](double, double) { return 1.0; }},
      {"x", [](double x, double) { return x; }, [](double, double) { return 1.0; }, zero},
      {"pi/3", [](double, double) { return pi / 3; }, zero, zero},
  };
  return table;
}

}  // namespace

TEST_CASE("expressions have the values that C++ gives them") {
  const struct {
    std::string text;
    double value;
  } table[] = {
      {"1 + 2*3", 7.0},
      {"(1 + 2)*3", 9.0},
      {"2 - 3 - 4", -5.0},
      {"16/4/2", 2.0},
      {"-2^2", -4.0},
      {"(-2)^2", 4.0},
      {"2^3^2", 512.0},
      {"2^-2", 0.25},
      {"2*-3", -6.0},
      {"+5", 5.0},
      {"4 - -1", 5.0},
      {"1e-3", 1e-3},
      {".5", 0.5},
      {"2.", 2.0},
      {"1.5e+2", 150.0},
      {"1E2", 100.0},
      {"pi", pi},
      {"e", e},
      {"2*pi", 2 * pi},
      {"abs(-3)", 3.0},
      {"min(2, -1)", -1.0},
      {"max(2, -1)", 2.0},
      {"atan2(1, -1)", 3 * pi / 4},
      {"atan2(-1, -1)", -3 * pi / 4},
      {"atan2(1, 1)", pi / 4},
      {"atan2(-1, 1)", -pi / 4},
      {"sqrt(2)", std::sqrt(2.0)},
      {"1/3", 1.0 / 3.0},
      {"0.1 + 0.2", 0.1 + 0.2},
      {"2^0.5", std::pow(2.0, 0.5)},
      {"0^0", 1.0},
      {"\t1\n+ 1 ", 2.0},
      {"((((1))))", 1.0},
  };
  for (const auto& [text, value] : table) {
    CAPTURE(text);
    CHECK_THAT(Expression(text, {})({}), WithinRel(value, 1e-15));
  }
  CHECK(Expression("1/0", {})({}) == infinity);
  CHECK(std::isnan(Expression("log(-1)", {})({})));
  CHECK(Expression("a - b*c^d", {"a", "b", "c", "d"})({1.0, 2.0, 3.0, 4.0}) == 1.0 - 2.0 * 81.0);
}

TEST_CASE("an expression knows what it depends on") {
  const std::vector<std::string> names = {"x", "t"};
  CHECK(Expression("1 + pi", names).is_constant());
  CHECK_FALSE(Expression("x", names).is_constant());
  CHECK(Expression("sin(t)*x", names).depends_on(0));
  CHECK(Expression("sin(t)*x", names).depends_on(1));
  CHECK_FALSE(Expression("sin(t)", names).depends_on(0));
  CHECK(Expression(" x ", names).text() == " x ");
}

TEST_CASE("values and derivatives of every operator and function are exact to round-off") {
  std::vector<std::string> covered;
  for (const Known& k : known()) {
    covered.push_back(k.text.substr(0, k.text.find('(')));
    const Expression f(k.text, {"x", "t"});
    const auto x = random_points(300, k.low, k.high);
    for (const double t : {0.3, 1.7}) {
      const Values s = values_of(f, x, t);
      double gap = 0.0, gap_x = 0.0, gap_t = 0.0;
      const auto relative = [](double a, double b) { return std::abs(a - b) / (1.0 + std::abs(b)); };
      for (std::size_t i = 0; i < x.size(); ++i) {
        gap = std::max(gap, relative(s.value[i], k.f(x[i], t)));
        gap_x = std::max(gap_x, relative(s.by_x[i], k.f_x(x[i], t)));
        gap_t = std::max(gap_t, relative(s.by_t[i], k.f_t(x[i], t)));
      }
      CAPTURE(k.text, t);
      CHECK(gap < 1e-14);
      CHECK(gap_x < 2e-13);  // near a pole of tan or at the ends of asin a few digits go
      CHECK(gap_t < 2e-13);
    }
  }
  for (const std::string& name : Expression::function_names()) {
    CAPTURE(name);
    CHECK(std::find(covered.begin(), covered.end(), name) != covered.end());
  }
}

TEST_CASE("asking for a derivative does not change the value, nor the other derivative") {
  const auto x = random_points(200, 0.1, 3.0);
  for (const Known& k : known()) {
    CAPTURE(k.text);
    const Expression f(k.text, {"x", "t"});
    const Values all = values_of(f, x, 0.4);
    std::vector<double> value(x.size()), by_x(x.size()), by_t(x.size());
    f.evaluate(x, {0.4}, {value, {}, {}});
    f.evaluate(x, {0.4}, {{}, by_x, {}});
    f.evaluate(x, {0.4}, {{}, {}, by_t});
    const auto same = [](const std::vector<double>& a, const std::vector<double>& b) {
      return std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
    };
    CHECK(same(value, all.value));
    CHECK(same(by_x, all.by_x));
    CHECK(same(by_t, all.by_t));
  }
}

TEST_CASE("powers of a vanishing base have their derivatives") {
  const auto slope_at_zero = [](const std::string& text) {
    return values_of(Expression(text, {"x", "t"}), {0.0}, 2.0).by_x[0];
  };
  CHECK(slope_at_zero("x^2") == 0.0);
  CHECK(slope_at_zero("x^3") == 0.0);
  CHECK(slope_at_zero("x^1") == 1.0);
  CHECK(slope_at_zero("(x - 1)^2") == -2.0);
  CHECK(slope_at_zero("x^t") == 0.0);
  CHECK(slope_at_zero("3*x^2 + 5*x") == 5.0);
  CHECK(values_of(Expression("x^2", {"x", "t"}), {-3.0}, 0.0).by_x[0] == -6.0);
  CHECK_THAT(values_of(Expression("x^3", {"x", "t"}), {-2.0}, 0.0).by_x[0], WithinRel(12.0, 1e-15));
}

TEST_CASE("atan2 and its derivative are right in all quadrants") {
  const Expression angle("atan2(2*sin(x), 2*cos(x))", {"x", "t"});
  for (int i = 0; i < 48; ++i) {
    const double x = -pi + (i + 0.5) * pi / 24.0;
    CAPTURE(x);
    const Values s = values_of(angle, {x}, 0.0);
    CHECK_THAT(s.value[0], WithinAbs(x, 1e-15));
    CHECK_THAT(s.by_x[0], WithinRel(1.0, 1e-15));
  }
}

TEST_CASE("a value does not depend on where in an array its point stands") {
  const auto x = random_points(1000, 0.1, 0.9);
  for (const Known& k : known()) {
    CAPTURE(k.text);
    const Expression f(k.text, {"x", "t"});
    const Values whole = values_of(f, x, 0.7);
    std::vector<Values> alone;
    for (const double point : x) alone.push_back(values_of(f, {point}, 0.7));
    for (const std::size_t count : {1u, 7u, 8u, 127u, 128u, 129u, 1000u}) {
      for (const std::size_t first : {0u, 3u}) {
        if (first + count > x.size()) continue;
        const std::vector<double> part(x.begin() + first, x.begin() + first + count);
        const Values s = values_of(f, part, 0.7);
        bool same = true;
        for (std::size_t i = 0; i < count; ++i) {
          const Values& one = alone[first + i];
          same = same && std::memcmp(&s.value[i], &one.value[0], sizeof(double)) == 0 &&
                 std::memcmp(&s.by_x[i], &one.by_x[0], sizeof(double)) == 0 &&
                 std::memcmp(&s.by_t[i], &one.by_t[0], sizeof(double)) == 0;
        }
        CAPTURE(count, first);
        CHECK(same);
      }
    }
    CHECK(f({x[0], 0.7}) == whole.value[0]);
  }
}

TEST_CASE("functions of whole vectors are within 4 units in the last place of the scalar ones") {
  const struct {
    std::string text;
    double (*f)(double);
    double low, high;
  } table[] = {{"sin(x)", std::sin, -30.0, 30.0},
               {"cos(x)", std::cos, -30.0, 30.0},
               {"exp(x)", std::exp, -20.0, 20.0},
               {"log(x)", std::log, 1e-3, 1e3}};
  for (const auto& [text, f, low, high] : table) {
    CAPTURE(text);
    const auto x = random_points(20000, low, high);
    const Values s = values_of(Expression(text, {"x", "t"}), x, 0.0);
    double worst = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) worst = std::max(worst, ulps(s.value[i], f(x[i])));
    CHECK(worst <= 4.0);
  }
}

TEST_CASE("expressions are shared between threads") {
  const Expression f("exp(sin(x - t))*atan2(x, 1 + t) + x^3", {"x", "t"});
  const auto x = random_points(777, -3.0, 3.0);
  const Values expected = values_of(f, x, 0.3), other = values_of(f, x, 0.9);
  std::vector<int> wrong(4, 0);
  {
    std::vector<std::jthread> threads;
    for (int thread = 0; thread < 4; ++thread) {
      threads.emplace_back([&, thread] {
        for (int i = 0; i < 50; ++i) {
          const bool first = (i + thread) % 2 == 0;
          const Values s = values_of(f, x, first ? 0.3 : 0.9);
          const Values& reference = first ? expected : other;
          wrong[thread] += s.value != reference.value || s.by_x != reference.by_x || s.by_t != reference.by_t;
          // Compiling in one thread does not disturb another.
          wrong[thread] += Expression("x*" + std::to_string(thread) + " + 1", {"x"})({2.0}) != 2.0 * thread + 1.0;
        }
      });
    }
  }
  CHECK(wrong == std::vector<int>(4, 0));
}

TEST_CASE("a bad text is refused with its place and its reason") {
  const struct {
    std::string text;
    std::size_t position;
    std::string message;
  } table[] = {
      {"", 0, "the expression is empty"},
      {"  \t", 0, "the expression is empty"},
      {"x +", 2, "the expression ends too early"},
      {"2^", 1, "the expression ends too early"},
      {"sin", 0, "the function \"sin\" needs its argument in parentheses"},
      {"1 + cos x", 4, "the function \"cos\" needs its argument in parentheses"},
      {"sin()", 4, "too few arguments for \"sin\""},
      {"atan2(x)", 7, "too few arguments for \"atan2\""},
      {"min(x, t, 1)", 11, "too many arguments for \"min\""},
      {"sin(x", 4, "a closing parenthesis is missing"},
      {"x)", 1, "unexpected parenthesis \")\""},
      {"x(2)", 1, "unexpected parenthesis \"(\""},
      {"y + 1", 0, "unknown name \"y\"; it may use x, t, pi, e and the usual functions"},
      {"x + foo(t)", 4, "unknown name \"foo\"; it may use x, t, pi, e and the usual functions"},
      {"2 x", 2, "unexpected value \"x\"; an operator is missing before it"},
      {"x t", 2, "unexpected value \"t\"; an operator is missing before it"},
      {"1.2.3", 3, "unexpected value \".3\"; an operator is missing before it"},
      {"2 sin(x)", 2, "unexpected function \"sin\"; an operator is missing before it"},
      {"x, 1", 1, "unexpected comma"},
      {"max(x,,1)", 6, "unexpected comma"},
      {"x > 1", 2, "unexpected \">\"; an expression has no conditions"},
      {"x ? 1 : 2", 2, "unexpected \"?\"; an expression has no conditions"},
      {"x = 2", 2, "unexpected \"=\"; an expression has no conditions"},
      {"x; t", 1, "unexpected \";\"; an expression has no conditions"},
      {"x!", 1, "unexpected \"!\"; an expression has no conditions"},
  };
  for (const auto& [text, position, message] : table) {
    CAPTURE(text);
    try {
      const Expression f(text, {"x", "t"});
      FAIL_CHECK("accepted, value " << f({1.5, 0.25}));
    } catch (const ExpressionError& error) {
      CHECK(error.what() == message);
      CHECK(error.position == position);
    }
  }
  for (const std::string text :
       {"* x", "x ** 2", "1e400", "2e", "x @ 2", "\"x\"", "cos(x) + +", "0x10", "#", "1 2", "()"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(Expression(text, {"x", "t"}), ExpressionError);
  }
}

TEST_CASE("a number beyond double precision is refused, not taken for another value") {
  for (const char* text : {"x + 1e-400", "1e400*x"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(Expression(text, {"x"}), ExpressionError);
  }
}
