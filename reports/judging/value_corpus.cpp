#include "reports/judging/value_corpus.hpp"

#include <fmt/format.h>

#include <cmath>
#include <random>

#include "reports/judging/random.hpp"

namespace acstudy {

namespace {

using enum Verdict;

/// Ratios that are no integers and not equal.
const std::vector<double> uneven = {0.1, 0.071, 0.043, 0.0193, 0.011, 0.0047};

std::vector<double> refined(double ratio, int n) {
  std::vector<double> variables;
  for (int i = 0; i < n; ++i) variables.push_back(0.1 * std::pow(ratio, -i));
  return variables;
}

/// 3 plus an error, rounded to some places after the point if there are any.
template <class Error>
std::vector<Value> around(const std::vector<double>& variables, Error error, int places = 0) {
  std::vector<Value> values;
  for (const double v : variables) {
    const double unit = std::pow(10.0, -places);
    const double value = 3.0 + error(v);
    values.push_back(places == 0 ? Value{v, value} : Value{v, std::round(value / unit) * unit, unit / 2.0});
  }
  return values;
}

auto power(double p, double D = 0.0, double q = 1.0) {
  return [=](double v) { return -0.3 * std::pow(v, p) * (1.0 + D * std::pow(v, q)); };
}

}  // namespace

std::vector<ValueEntry> value_corpus() {
  std::vector<ValueEntry> all;
  const std::vector<Verdict> holds = {confirmed, pre_asymptotic};
  for (const double p : {0.5, 1.0, 2.0, 3.0}) {
    all.push_back({fmt::format("order {}", p), around(refined(2.0, 5), power(p)), p, {confirmed}, "exactly theory's"});
    all.push_back({fmt::format("order {}, uneven ratios", p),
                   around(uneven, power(p)),
                   p,
                   {confirmed},
                   "differences at unequal ratios follow v_i^p - v_(i+1)^p"});
    all.push_back({fmt::format("order {} for {}", p, p + 0.5),
                   around(uneven, power(p)),
                   p + 0.5,
                   {below},
                   "half an order less than theory's"});
    all.push_back({fmt::format("order {} for {}", p + 0.5, p),
                   around(uneven, power(p + 0.5)),
                   p,
                   {above},
                   "half an order more than theory's"});
  }
  all.push_back({"order 2, printed to six places", around(refined(2.0, 4), power(2.0), 6), 2.0, holds,
                 "digits leave less than 2 % of the last difference open"});
  all.push_back({"order 2, printed to four places",
                 around(refined(2.0, 6), power(2.0), 4),
                 2.0,
                 {floor},
                 "the last differences are less than the printed digits tell"});
  for (const double D : {-3.0, 4.0}) {
    all.push_back({fmt::format("v (1 {:+} v)", D), around(refined(2.0, 7), power(1.0, D)), 1.0, holds,
                   "order 1 in the limit, a correction on the way"});
  }
  std::mt19937_64 generator(5);
  all.push_back({"order 2 with 0.2 % scatter",
                 around(refined(2.0, 7), [&](double v) { return v * v * std::exp(0.002 * normal(generator)); }), 2.0,
                 holds, "the scatter is small against the error"});
  const auto swinging = [sign = 1.0](double v) mutable { return (sign = -sign) * v * v; };
  all.push_back({"swings about the limit",
                 around(refined(2.0, 6), swinging),
                 2.0,
                 {inconclusive},
                 "no monotone law describes values that alternate"});
  all.push_back({"runs away", around(refined(2.0, 5), power(-1.0)), 1.0, {diverges}, "the differences double"});
  all.push_back({"swings and runs away",
                 around(refined(2.0, 5), [sign = 1.0](double v) mutable { return (sign = -sign) / v; }),
                 1.0,
                 {diverges},
                 "the differences double and alternate"});
  all.push_back({"grows like the logarithm",
                 around(refined(2.0, 6), [](double v) { return std::log(v); }),
                 1.0,
                 {stagnates, below},
                 "the differences are all the same"});
  all.push_back({"three levels",
                 around(refined(2.0, 3), power(1.0)),
                 1.0,
                 {inconclusive},
                 "three levels solve exactly for three unknowns"});
  return all;
}

}  // namespace acstudy
