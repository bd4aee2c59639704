#include "reports/judging/scan.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "reports/judging/random.hpp"

namespace acstudy {

namespace {

constexpr double shown = 0.05;  ///< how close to an order a pairwise order shows it

/// Rounded to so many significant digits, and the standard deviation that this leaves, relative.
Level rounded(double variable, double error, int digits) {
  const double unit = std::pow(10.0, std::floor(std::log10(error)) - (digits - 1));
  const double value = std::round(error / unit) * unit;
  return {.variable = variable, .error = value, .noise = 0.5 * unit / value / std::sqrt(3.0)};
}

bool passes(Verdict verdict, double theory_order) {
  return meets(verdict, theory_order == 0.0 ? Verdict::stagnates : Verdict::confirmed);
}

bool is_false(const ScanTruth& truth, Verdict verdict, double theory_order) {
  if (verdict == Verdict::inconclusive) return false;
  if (passes(verdict, theory_order)) return !truth.may_pass;
  if (!truth.may_depart) return true;
  if (verdict == Verdict::below) return truth.side > 0;
  if (verdict == Verdict::above) return truth.side < 0;
  return true;  // these errors fall: no other verdict is right
}

}  // namespace

std::string_view name_of(Printing printing) {
  constexpr std::string_view names[] = {"2 digits", "3 digits", "4 digits", "2 % noise"};
  return names[static_cast<std::size_t>(printing)];
}

double ScanSeries::exact(double h) const { return std::pow(h, p1) + D * std::pow(h, p2); }

std::vector<Level> ScanSeries::errors() const {
  std::mt19937_64 generator(seed);
  std::vector<Level> all;
  for (int i = 0; i < levels; ++i) {
    const double h = std::pow(ratio, -i), error = exact(h);
    all.push_back(printing == Printing::noise ? Level{h, error * std::exp(0.02 * normal(generator))}
                                              : rounded(h, error, 2 + static_cast<int>(printing)));
  }
  return all;
}

std::vector<double> ScanSeries::pairwise() const {
  std::vector<double> orders;
  for (int i = 1; i < levels; ++i) {
    orders.push_back(std::log(exact(std::pow(ratio, 1 - i)) / exact(std::pow(ratio, -i))) / std::log(ratio));
  }
  return orders;
}

ScanTruth truth_of(const ScanSeries& series, double theory_order) {
  const std::vector<double> pairwise = series.pairwise();
  const auto side = [&](double order) { return order < theory_order ? -1 : order > theory_order ? +1 : 0; };
  const bool limit = theory_order == series.p1;
  if (std::abs(pairwise.back() - series.p1) <= shown) return {limit, !limit, false, side(series.p1)};
  const double missing = series.p2 - pairwise.back();
  if (missing > shown && missing <= 2.0 * shown) {
    const bool either = limit || theory_order == series.p2;
    return {either, true, true, 0};
  }
  const bool first_term_hidden = missing <= shown;
  if (first_term_hidden) {
    const bool second = theory_order == series.p2;
    // The orders may yet fall to one below p2.
    return {second, !second, theory_order > 0.0 && theory_order < series.p2, theory_order < series.p2 ? 0 : -1};
  }
  return {limit, !limit, true, 0};
}

ScanRow Scan::all() const {
  ScanRow sum{};
  for (const ScanRow& row : rows) {
    sum.judged += row.judged;
    sum.false_firm += row.false_firm;
    sum.decidable += row.decidable;
    sum.decided += row.decided;
  }
  return sum;
}

Scan scan_two_terms(std::int64_t every, std::uint64_t seed, const JudgeOrders& judge) {
  Scan scan;
  std::int64_t number = 0;
  // A step through the grid that shares no factor with its sizes meets all of each.
  for (int levels = 4; levels <= 10; ++levels) {
    for (const Printing printing : printings) {
      ScanRow& row = scan.rows.emplace_back(ScanRow{levels, printing});
      for (const double ratio : {1.3, 1.5, 2.0}) {
        for (int p1 = 1; p1 < 12; ++p1) {
          for (int p2 = p1 + 1; p2 <= 12; ++p2) {
            for (int decade = -3; decade <= 6; ++decade) {
              if (number++ % every != 0) continue;
              const ScanSeries series{0.5 * p1,
                                      0.5 * p2,
                                      std::pow(10.0, decade),
                                      levels,
                                      ratio,
                                      printing,
                                      seed + static_cast<std::uint64_t>(number)};
              std::vector<double> orders = {series.p1, series.p2, series.p1 - 0.5, series.p1 + 0.5, 0.0};
              std::sort(orders.begin(), orders.end());
              orders.erase(std::unique(orders.begin(), orders.end()), orders.end());
              const std::vector<Verdict> verdicts = judge(series.errors(), orders);
              for (std::size_t i = 0; i < orders.size(); ++i) {
                const ScanTruth truth = truth_of(series, orders[i]);
                const bool wrong = is_false(truth, verdicts[i], orders[i]);
                const bool open = verdicts[i] == Verdict::inconclusive;
                ++row.judged;
                row.false_firm += wrong ? 1 : 0;
                if (!truth.may_be_undecided) {
                  ++row.decidable;
                  row.decided += open ? 0 : 1;
                }
                if (wrong || (open && !truth.may_be_undecided)) {
                  scan.mistakes.push_back({series, orders[i], verdicts[i], wrong});
                }
              }
            }
          }
        }
      }
    }
  }
  return scan;
}

Scan scan_two_terms(std::int64_t every, std::uint64_t seed) {
  return scan_two_terms(every, seed, [](LevelView levels, const std::vector<double>& orders) {
    std::vector<Verdict> verdicts;
    for (const Judgement& one : judge(levels, orders, {})) verdicts.push_back(one.verdict);
    return verdicts;
  });
}

}  // namespace acstudy
