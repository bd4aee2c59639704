#pragma once

/// @file
/// Two sets of results side by side: the same findings, cases and points of both, and what differs.

#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "studies/commands/compare/result_set.hpp"

namespace acstudy {

/// A thing of the older set and of the newer one; null where it is in one only.
template <class T>
struct Pair {
  const T* before = nullptr;
  const T* after = nullptr;

  bool both() const { return before != nullptr && after != nullptr; }
  const T& any() const { return before != nullptr ? *before : *after; }
};

/// What has become of a finding, worst first.
enum class Change {
  worsened,  ///< it was as expected, and is not any more, by what is expected now or by what was expected before
  expected,  ///< the study expects something else; the verdict meets what is expected now as it did before
  improved,  ///< it was not as expected, and is
  verdict,   ///< another verdict, which departs like the one before, or like it does not
  gone,      ///< in the older set only
  added,     ///< in the newer set only
  none,
};
std::string_view name_of(Change change);

/// The same number to the last bit; what is not finite is null in JSON, so that it is all the same.
bool same(double before, double after);

/// newer/older; NaN where that says nothing: one of them is 0 or not finite, or their signs differ.
double ratio(double before, double after);

/// How many of some numbers are the same, and how far apart the others are.
struct Tally {
  std::size_t all = 0, equal = 0;
  double low = std::numeric_limits<double>::infinity(), high = 0.0;  ///< smallest and largest ratio
  bool without_ratio = false;                                        ///< some differ, and have no ratio

  void count(double before, double after);
  void add(const Tally& other);
  bool differs() const { return equal < all; }
  /// How far the ratios are from 1, as a logarithm; infinite where something has none.
  double distance() const;
};

/// A sum over the cases that are in both sets.
struct Sum {
  double before = 0.0, after = 0.0;

  void add(const Sum& other);
};

struct Numbers {
  Tally errors;                     ///< of cases in the maximum norm, which are judged
  Tally norms;                      ///< of cases in the other norms
  Tally values;                     ///< of points
  Tally work;                       ///< counts of work
  Tally orders;                     ///< observed orders and the ends of their intervals
  Tally others;                     ///< all else that is stored of cases and points, but times
  std::size_t gone = 0, added = 0;  ///< cases and points that are in one set only
  Sum pairs, seconds;

  void add(const Numbers& other);
  bool differ() const;

  static const std::array<Tally Numbers::*, 6> tallies;
};

inline constexpr std::array<Tally Numbers::*, 6> Numbers::tallies = {
    &Numbers::errors, &Numbers::norms, &Numbers::values, &Numbers::work, &Numbers::orders, &Numbers::others};

/// A case or a point, and the names of what differs in it, as files call it: "error_linf", "work_pairs".
template <class T>
struct Matched : Pair<T> {
  std::vector<std::string> differ = {};
};

struct FindingComparison : Pair<FindingRecord> {
  Change change = Change::none;
  std::string why = {};  ///< it has worsened
  std::vector<Matched<CaseRecord>> cases = {};
  std::vector<Matched<Point>> points = {};
  Numbers numbers = {};
};

struct StudyComparison : Pair<ResultRecord> {
  std::vector<FindingComparison> findings = {};  ///< in the order of the older study; those that it has not come last
  std::string worsened = {};                     ///< why the study as a whole has, if so
  Numbers numbers = {};
};

struct Comparison {
  const ResultSet *before, *after;
  std::vector<StudyComparison> studies = {};
  Numbers numbers = {};

  std::size_t count(Change change) const;
  /// Findings that are in both sets.
  std::size_t matched() const;
  /// A verdict has, or a study as a whole.
  bool worsened() const;
  /// All of both sets is the same but times.
  bool identical() const;
};

/// Compares two sets, which have to outlive the result. A finding is known by study, statement, subject and
/// coordinates, or else by its name; a case or a point by N, h, delta and what it is drawn over.
/// @throws InputError if a study has two findings that cannot be told apart, or if nothing is in both sets
Comparison compare(const ResultSet& before, const ResultSet& after);

}  // namespace acstudy
