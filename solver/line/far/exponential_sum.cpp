#include "solver/line/far/exponential_sum.hpp"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <mutex>
#include <numbers>
#include <stdexcept>

namespace acstudy::far {

namespace {

using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

/// s exp(-r s) r at distances s (rows) and rates r (columns): what a term adds to s (1/s) = 1, per step of log r.
Matrix terms(const Vector& s, const Vector& r) {
  Matrix A(s.size(), r.size());
  for (Eigen::Index m = 0; m < r.size(); ++m) {
    for (Eigen::Index i = 0; i < s.size(); ++i) A(i, m) = s[i] * std::exp(-s[i] * r[m]) * r[m];
  }
  return A;
}

/// Chebyshev points of log s.
Vector distances(long double ratio, Eigen::Index count) {
  Vector s(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const long double angle = std::numbers::pi_v<long double> * (i + 0.5L) / count;
    s[i] = std::pow(ratio, 0.5L * (1.0L + std::cos(angle)));
  }
  return s;
}

/// Rates, in the order in which they improve the fit the most, and the factorization of their terms.
struct Candidates {
  explicit Candidates(long double ratio) : s(distances(ratio, 96)), rates(200) {
    const long double lowest = 0.1L / ratio, highest = 30.0L;
    for (Eigen::Index m = 0; m < rates.size(); ++m) {
      rates[m] = lowest * std::pow(highest / lowest, static_cast<long double>(m) / (rates.size() - 1));
    }
    const Eigen::ColPivHouseholderQR<Matrix> factors(terms(s, rates));
    rates = factors.colsPermutation().transpose() * rates;
    const auto pivots = factors.matrixQR().diagonal().cwiseAbs();
    while (telling < pivots.size() && pivots[telling] > 1e-12L * pivots[0]) ++telling;
  }
  Vector s, rates;
  int telling = 0;  ///< rates with which the fit is not yet near round-off
};

ExponentialSum fitted(const Candidates& candidates, long double ratio, int count) {
  const Vector r = candidates.rates.head(count);
  const Vector w = terms(candidates.s, r).householderQr().solve(Vector::Ones(candidates.s.size()));
  ExponentialSum sum;
  sum.count = count;
  sum.padded = (count + 7) / 8 * 8;
  sum.ratio = static_cast<double>(ratio);
  for (int m = 0; m < count; ++m) {
    sum.rate[m] = static_cast<double>(r[m]);
    sum.weight[m] = static_cast<double>(w[m] * r[m]);
  }
  const Vector fine = distances(ratio, 500);
  for (const long double s : fine) {
    long double value = 0.0L;
    for (int m = 0; m < count; ++m) value += sum.weight[m] * std::exp(-s * sum.rate[m]);
    sum.error = std::fmax(sum.error, static_cast<double>(std::abs(s * value - 1.0L)));
  }
  return sum;
}

long double ratio_of(int log2_ratio) {
  if (log2_ratio < 1 || log2_ratio > max_log2_ratio) throw std::invalid_argument("no exponential sum for this ratio");
  return std::ldexp(1.0L, log2_ratio);
}

}  // namespace

ExponentialSum reciprocal_sum(int log2_ratio, int count) {
  const long double ratio = ratio_of(log2_ratio);
  return fitted(Candidates(ratio), ratio, count);
}

const ExponentialSum& reciprocal_sum(int log2_ratio) {
  static std::array<ExponentialSum, max_log2_ratio + 1> sums;
  static std::array<std::once_flag, max_log2_ratio + 1> computed;
  const long double ratio = ratio_of(log2_ratio);
  std::call_once(computed[log2_ratio], [&] {
    constexpr double round_off = 3e-15;
    const Candidates candidates(ratio);
    int count = candidates.telling / 2 * 2;
    do sums[log2_ratio] = fitted(candidates, ratio, count += 2);
    while (sums[log2_ratio].error > round_off && count + 2 <= ExponentialSum::capacity);
  });
  return sums[log2_ratio];
}

}  // namespace acstudy::far
