#include "solver/line/vector/moment_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace acstudy {

namespace {

constexpr int nodes = MomentTable::most_terms;
using Coefficients = std::array<long double, nodes>;

/// sum_k c_k T_k(t / half), as coefficients of powers of t.
Coefficients in_powers(const Coefficients& c, long double half) {
  Coefficients before{1.0L}, now{0.0L, 1.0L / half}, sum{c[0]};
  for (int k = 1; k < nodes; ++k) {
    for (int i = 0; i <= k; ++i) sum[i] += c[k] * now[i];
    Coefficients next{};
    for (int i = 0; i < nodes; ++i) next[i] = (i > 0 ? 2.0L * now[i - 1] / half : 0.0L) - before[i];
    before = std::exchange(now, next);
  }
  return sum;
}

class Tabulation {
 public:
  explicit Tabulation(const std::function<double(double)>& moment) : moment_(moment), floor_(0x1p-60 * moment(1.0)) {
    constexpr double near = 0x1p-30;
    const double order = std::log2(moment(2.0 * near) / moment(near));
    const bool whole = std::abs(order - std::round(order)) < 1e-6 && order < 12.5;
    table_.power = whole ? static_cast<int>(std::round(order)) : -1;
  }

  MomentTable of(std::span<const double> breaks) {
    double begin = 0.0;
    for (const double end : breaks) cut(std::exchange(begin, end), end);
    cut(begin, 1.0);
    table_.bounds.push_back(1.0);
    return std::move(table_);
  }

 private:
  /// Nearer particles are rare enough for a function that takes one at a time.
  static constexpr double close = 0x1p-12;

  void cut(double begin, double end) {
    const bool any_power = begin == 0.0 && table_.power < 0;
    if (any_power ? end <= close && add(begin, end, {}, true)
                  : add(begin, end, fit(begin, end), end - begin < 0x1p-40)) {
      return;
    }
    const double middle = 0.5 * (begin + end);
    cut(begin, middle);
    cut(middle, end);
  }

  /// The polynomial through the moment at Chebyshev's points, less what is below its last digit.
  Coefficients fit(double begin, double end) const {
    const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
    Coefficients c{};
    long double least = std::numeric_limits<long double>::infinity();
    for (int i = 0; i < nodes; ++i) {
      const long double angle = std::numbers::pi_v<long double> * (i + 0.5L) / nodes;
      const double z = middle + half * static_cast<double>(std::cos(angle));
      const long double value =
          moment_(z) / (begin == 0.0 ? std::pow(static_cast<long double>(z), table_.power) : 1.0L);
      least = std::min(least, value);
      for (int k = 0; k < nodes; ++k) c[k] += value * std::cos(k * angle) * (k == 0 ? 1.0L : 2.0L) / nodes;
    }
    long double dropped = 0.0L;
    for (int k = nodes - 1; k > 0; --k) {
      dropped += std::abs(c[k]);
      if (dropped > 0x1p-48L * least) break;
      c[k] = 0.0L;
    }
    return in_powers(c, half);
  }

  /// Adds it as the last piece; takes it away again if it is not the moment but for some units in the last place.
  bool add(double begin, double end, const Coefficients& c, bool whatever) {
    const std::size_t piece = table_.origin.size();
    table_.bounds.push_back(begin);
    table_.origin.push_back(0.5 * (begin + end));
    std::ptrdiff_t terms = nodes;
    while (terms > 1 && c[terms - 1] == 0.0L) --terms;
    table_.terms.push_back(terms);
    for (const long double each : c) table_.coefficient.push_back(static_cast<double>(each));
    for (int i = 0; i <= 2 * nodes && !whatever; ++i) {
      const double z = begin + (end - begin) * 0.5 * (1.0 - std::cos(std::numbers::pi * i / (2 * nodes)));
      if (z == 0.0) continue;
      const double exact = moment_(z);
      if (std::abs(table_.at(piece, z) - exact) <= 0x1p-47 * exact + floor_) continue;
      table_.bounds.pop_back();
      table_.origin.pop_back();
      table_.terms.pop_back();
      table_.coefficient.resize(table_.coefficient.size() - nodes);
      return false;
    }
    return true;
  }

  const std::function<double(double)>& moment_;
  double floor_;  ///< no digits are asked of what is nothing beside the whole, even divided by a distance
  MomentTable table_;
};

}  // namespace

double MomentTable::at(std::size_t piece, double z) const {
  const double* const c = coefficient.data() + piece * most_terms;
  const double t = z - origin[piece];
  double value = 0.0;
  for (std::ptrdiff_t k = terms[piece]; k-- > 0;) value = value * t + c[k];
  return piece == 0 ? value * std::pow(z, power) : value;
}

MomentTable moment_table(const std::function<double(double)>& moment, std::span<const double> breaks) {
  return Tabulation(moment).of(breaks);
}

}  // namespace acstudy
