#include <algorithm>
#include <cmath>
#include <limits>

#include "studies/commands/compare/comparison.hpp"

namespace acstudy {

bool same(double before, double after) { return before == after || (!std::isfinite(before) && !std::isfinite(after)); }

double ratio(double before, double after) {
  const double quotient = after / before;
  const bool sound = before != 0.0 && std::isfinite(before) && std::isfinite(quotient) && quotient > 0.0;
  return sound ? quotient : std::numeric_limits<double>::quiet_NaN();
}

void Tally::count(double before, double after) {
  const bool alike = same(before, after);
  const double quotient = alike ? 1.0 : ratio(before, after);
  ++all;
  equal += alike ? 1 : 0;
  without_ratio = without_ratio || std::isnan(quotient);
  low = std::fmin(low, quotient);
  high = std::fmax(high, quotient);
}

void Tally::add(const Tally& other) {
  all += other.all;
  equal += other.equal;
  low = std::min(low, other.low);
  high = std::max(high, other.high);
  without_ratio = without_ratio || other.without_ratio;
}

double Tally::distance() const {
  if (!differs()) return 0.0;
  return without_ratio ? std::numeric_limits<double>::infinity() : std::max(-std::log(low), std::log(high));
}

void Sum::add(const Sum& other) {
  before += other.before;
  after += other.after;
}

void Numbers::add(const Numbers& other) {
  for (Tally Numbers::*const tally : tallies) (this->*tally).add(other.*tally);
  gone += other.gone;
  added += other.added;
  pairs.add(other.pairs);
  seconds.add(other.seconds);
}

bool Numbers::differ() const {
  return gone + added > 0 ||
         std::any_of(tallies.begin(), tallies.end(), [&](Tally Numbers::*tally) { return (this->*tally).differs(); });
}

}  // namespace acstudy
