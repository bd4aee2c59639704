#pragma once

/// @file
/// Every series C h^p1 + D h^p2 of a grid, printed with few digits or with noise, judged against several orders: how
/// often is a judge firm and wrong, and how often does it decide what can be decided?

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "reports/judging/orders.hpp"

namespace acstudy {

/// How the errors of a series come to the judge.
enum class Printing { two_digits, three_digits, four_digits, noise };
inline constexpr Printing printings[] = {Printing::two_digits, Printing::three_digits, Printing::four_digits,
                                         Printing::noise};
std::string_view name_of(Printing printing);

/// error = h^p1 + D h^p2 at h = 1, 1/ratio, 1/ratio^2, ...
struct ScanSeries {
  double p1, p2, D;
  int levels;
  double ratio;
  Printing printing;
  std::uint64_t seed = 0;  ///< of the noise, 2 % and lognormal

  double exact(double h) const;
  std::vector<Level> errors() const;  ///< as they are printed; the judge is told what rounding leaves of them
  /// Orders between successive levels, of the exact errors.
  std::vector<double> pairwise() const;
};

/// What may be said of a series if theory promises an order, whatever a judge says. It follows from the exact pairwise
/// orders: the last within 0.05 of p1, the order in the limit: theory's is right if it is p1. All of them within 0.05
/// of p2: nothing in the errors tells of p1, and p2 may be confirmed and p1 may not. Otherwise the errors are on their
/// way: p1 may be confirmed or not, and must not be contradicted; nothing else may be confirmed.
struct ScanTruth {
  bool may_pass, may_depart, may_be_undecided;
  int side;  ///< of the order in the limit as seen from theory's: -1 below, +1 above; 0: either may be said
};
ScanTruth truth_of(const ScanSeries& series, double theory_order);

/// Counts over series of one length and printing.
struct ScanRow {
  int levels;
  Printing printing;
  std::int64_t judged = 0, false_firm = 0;  ///< verdicts; those that pass what departs or condemn what holds
  std::int64_t decidable = 0, decided = 0;  ///< verdicts where the truth shows; those that are not inconclusive
};

struct ScanMistake {
  ScanSeries series;
  double theory_order;
  Verdict verdict;
  bool false_firm;
};

struct Scan {
  std::vector<ScanRow> rows;
  std::vector<ScanMistake> mistakes;  ///< what is false, or inconclusive where the truth shows

  ScanRow all() const;  ///< the sum of the rows
};

/// The verdicts on a series against several orders.
using JudgeOrders = std::function<std::vector<Verdict>(LevelView, const std::vector<double>& orders)>;

/// p1 and p2 in steps of 1/2 up to 6, D from 1e-3 to 1e6, 4 to 10 levels, ratios 1.3, 1.5 and 2, each printing; against
/// p1, p2, p1 - 1/2, p1 + 1/2 and 0.
/// @param every  judge one series in so many, spread over the grid
Scan scan_two_terms(std::int64_t every, std::uint64_t seed);
Scan scan_two_terms(std::int64_t every, std::uint64_t seed, const JudgeOrders& judge);

}  // namespace acstudy
