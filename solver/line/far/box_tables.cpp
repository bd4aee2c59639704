#include "solver/line/far/box_tables.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <mutex>
#include <numbers>

namespace acstudy::far {

namespace {

/// Coefficients in powers of t of the polynomial through exp(-a (1 + t)) at Chebyshev points.
template <int n>
std::array<double, n> exponential_over_box(long double a) {
  const auto angle = [](int i) { return std::numbers::pi_v<long double> * (i + 0.5L) / n; };
  std::array<long double, n> T_before{1.0L}, T{}, sum{};
  T[1] = 1.0L;
  for (int k = 0; k < n; ++k) {
    long double of_T_k = 0.0L;
    for (int i = 0; i < n; ++i) of_T_k += std::exp(-a * (1.0L + std::cos(angle(i)))) * std::cos(k * angle(i));
    of_T_k *= (k == 0 ? 1.0L : 2.0L) / n;
    for (int m = 0; m < n; ++m) sum[m] += of_T_k * T_before[m];
    std::array<long double, n> T_next{};
    for (int m = 0; m < n; ++m) T_next[m] = (m > 0 ? 2.0L * T[m - 1] : 0.0L) - T_before[m];
    T_before = T;
    T = T_next;
  }
  std::array<double, n> result;
  for (int m = 0; m < n; ++m) result[m] = static_cast<double>(sum[m]);
  return result;
}

/// @param nearest  the distance, in boxes, for which the sum of exponentials begins
template <int terms>
BoxExpansion<terms> expansion(const ExponentialSum& sum, double nearest) {
  BoxExpansion<terms> e{};
  e.count = sum.count;
  e.padded_count = sum.padded;
  for (int m = 0; m < sum.padded; ++m) {
    e.rate[m] = sum.rate[m] / nearest;
    e.decay[m] = std::exp(-e.rate[m]);
    const auto over_box = exponential_over_box<terms>(0.5L * e.rate[m]);
    for (int n = 0; n < terms; ++n) {
      e.in[n][m] = n % 2 == 0 ? over_box[n] : -over_box[n];
      e.out[m][n] = sum.weight[m] / nearest * over_box[n];
    }
  }
  return e;
}

int log2_at_least(int boxes) { return static_cast<int>(std::bit_width(static_cast<unsigned>(boxes - 1))); }

template <int terms>
BoxExpansion<terms> from_one_box_apart(int up_to) {
  return expansion<terms>(reciprocal_sum(log2_at_least(up_to)), 1.0);
}

template <bool two_pieces>
BoxTables<two_pieces> tables_of(int boxes) {
  using Tables = BoxTables<two_pieces>;
  if constexpr (two_pieces) {
    const int half = boxes / 2;
    return {boxes, from_one_box_apart<Tables::inner_terms>(half),
            expansion<Tables::outer_terms>(reciprocal_sum(1), half)};
  } else {
    return {boxes, from_one_box_apart<Tables::inner_terms>(boxes)};
  }
}

}  // namespace

template <bool two_pieces>
const BoxTables<two_pieces>* box_tables(double neighbors, double per_box) {
  constexpr std::array boxes{8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256};
  static std::array<std::unique_ptr<const BoxTables<two_pieces>>, boxes.size()> tables;
  static std::array<std::once_flag, boxes.size()> computed;
  std::size_t k = 0;
  while (k < boxes.size() && neighbors >= per_box * boxes[k]) ++k;
  if (k-- == 0) return nullptr;
  std::call_once(computed[k],
                 [&] { tables[k] = std::make_unique<const BoxTables<two_pieces>>(tables_of<two_pieces>(boxes[k])); });
  return tables[k].get();
}
template const BoxTables<false>* box_tables<false>(double, double);
template const BoxTables<true>* box_tables<true>(double, double);

}  // namespace acstudy::far
