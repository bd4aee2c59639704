#include "solver/line/vector/moment_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace acstudy {

namespace {

constexpr int most = MomentTable::most_terms;
using Coefficients = std::array<long double, most>;

/// sum_k c_k T_k(t / half), k < terms, as coefficients of powers of t.
Coefficients in_powers(const Coefficients& c, int terms, long double half) {
  Coefficients before{1.0L}, now{0.0L, 1.0L / half}, sum{c[0]};
  for (int k = 1; k < terms; ++k) {
    for (int i = 0; i <= k; ++i) sum[i] += c[k] * now[i];
    Coefficients next{};
    for (int i = 0; i < terms; ++i) next[i] = (i > 0 ? 2.0L * now[i - 1] / half : 0.0L) - before[i];
    before = std::exchange(now, next);
  }
  return sum;
}

class Tabulation {
 public:
  Tabulation(const std::function<double(double)>& moment, bool squared)
      : moment_(moment), floor_(0x1p-110 * moment(1.0)) {
    constexpr double near = 0x1p-30;
    const double order = std::log2(moment(2.0 * near) / moment(near));
    const int halves = static_cast<int>(std::round(2.0 * order));
    const bool whole = std::abs(2.0 * order - halves) < 1e-6 && order < 12.5;
    table_.power = whole ? halves / 2 : -1;
    table_.root = whole && halves % 2 != 0;
    table_.squared = squared;
  }

  MomentTable of(std::span<const double> breaks) {
    double begin = 0.0;
    for (const double end : breaks) cut(std::exchange(begin, end), end);
    cut(begin, 1.0);
    return std::move(table_);
  }

 private:
  /// Nearer particles are rare enough for a function that takes one at a time.
  static constexpr double close = 0x1p-12;

  void cut(double begin, double end) {
    if (begin == 0.0 && table_.power < 0) {
      if (end <= close) return table_.pieces.push_back({begin, end, 0.0, 1, {}});
    } else {
      const bool short_enough = end - begin < 0x1p-40;
      for (int terms = short_enough ? most : 1; terms <= most; terms += terms == 1 ? 1 : 2) {
        const MomentTable::Piece piece = fit(begin, end, terms);
        if (short_enough || is_good(piece)) return table_.pieces.push_back(piece);
      }
    }
    const double middle = 0.5 * (begin + end);
    cut(begin, middle);
    cut(middle, end);
  }

  /// The polynomial through the moment at Chebyshev's points.
  MomentTable::Piece fit(double begin, double end, int terms) const {
    const double from = variable(begin), to = variable(end), middle = 0.5 * (from + to), half = 0.5 * (to - from);
    Coefficients c{};
    for (int i = 0; i < terms; ++i) {
      const long double angle = std::numbers::pi_v<long double> * (i + 0.5L) / terms;
      const double t = middle + half * static_cast<double>(std::cos(angle)), z = table_.squared ? std::sqrt(t) : t;
      const long double value = moment_(z) / (begin == 0.0 ? table_.factor(static_cast<long double>(z)) : 1.0L);
      for (int k = 0; k < terms; ++k) c[k] += value * std::cos(k * angle) * (k == 0 ? 1.0L : 2.0L) / terms;
    }
    MomentTable::Piece piece{begin, end, middle, terms, {}};
    std::ranges::copy(in_powers(c, terms, half), piece.coefficient);
    return piece;
  }

  /// It is the moment but for some units in the last place.
  bool is_good(const MomentTable::Piece& piece) const {
    for (int i = 0; i <= 2 * most; ++i) {
      const double z =
          piece.begin + (piece.end - piece.begin) * 0.5 * (1.0 - std::cos(std::numbers::pi * i / (2 * most)));
      if (z == 0.0) continue;
      const double exact = moment_(z);
      if (!(std::abs(table_.at(piece, z) - exact) <= 0x1p-48 * exact + floor_)) return false;
    }
    return true;
  }

  double variable(double z) const { return table_.squared ? z * z : z; }

  const std::function<double(double)>& moment_;
  double floor_;  ///< far below what a cell weighs, even divided by its distance
  MomentTable table_;
};

}  // namespace

double MomentTable::at(const Piece& piece, double z) const {
  const double t = (squared ? z * z : z) - piece.origin;
  double value = 0.0;
  for (std::ptrdiff_t k = piece.terms; k-- > 0;) value = value * t + piece.coefficient[k];
  return piece.begin == 0.0 ? value * factor(z) : value;
}

MomentTable moment_table(const std::function<double(double)>& moment, std::span<const double> breaks) {
  MomentTable table = Tabulation(moment, false).of(breaks);
  if (table.power < 0 || table.pieces.size() == breaks.size() + 1) return table;
  MomentTable squared = Tabulation(moment, true).of(breaks);
  return squared.pieces.size() < table.pieces.size() ? squared : table;
}

}  // namespace acstudy
