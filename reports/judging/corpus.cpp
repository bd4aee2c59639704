#include "reports/judging/corpus.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "reports/judging/random.hpp"

namespace acstudy {

namespace {

using enum Verdict;
using Variables = std::vector<double>;

/// Ratios that are no integers and not equal.
const Variables uneven = {0.1, 0.071, 0.043, 0.0193, 0.011, 0.0047};

Variables refined(double first, double ratio, int n) {
  Variables variables;
  for (int i = 0; i < n; ++i) variables.push_back(first * std::pow(ratio, -i));
  return variables;
}

template <class Error>
std::vector<Level> levels(const Variables& variables, Error error) {
  std::vector<Level> all;
  for (const double v : variables) all.push_back({v, error(v)});
  return all;
}

auto power(double p) {
  return [p](double v) { return 0.3 * std::pow(v, p); };
}

auto two_terms(double p, double D, double q) {
  return [=](double v) { return 0.3 * std::pow(v, p) * (1.0 + D * std::pow(v, q)); };
}

std::vector<Level> noisy(std::vector<Level> all, double relative, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  for (Level& level : all) level.error *= std::exp(relative * normal(generator));
  return all;
}

std::vector<Level> with_error(std::vector<Level> all, std::size_t level, double error) {
  all[level].error = error;
  return all;
}

std::vector<Level> with_factor(std::vector<Level> all, std::size_t level, double factor) {
  all[level].error *= factor;
  return all;
}

using Entries = std::vector<CorpusEntry>;

void add_powers(Entries& all) {
  const std::vector<Verdict> sure = {confirmed};
  for (const double p : {0.5, 1.0, 2.0, 3.0}) {
    all.push_back(
        {fmt::format("order {}", p), levels(refined(0.1, 2.0, 5), power(p)), p, sure, "exactly theory's order"});
    all.push_back(
        {fmt::format("order {}, uneven ratios", p), levels(uneven, power(p)), p, sure, "no ratio is assumed"});
  }
  all.push_back(
      {"order 1, three levels", levels(refined(0.1, 2.0, 3), power(1.0)), 1.0, sure, "exact on three levels"});
  all.push_back({"order 1, ratio 1.1", levels(refined(0.1, 1.1, 6), power(1.0)), 1.0, sure, "small ratios are ratios"});
  all.push_back({"order 1, ratio 10", levels(refined(1.0, 10.0, 5), power(1.0)), 1.0, sure, "large ratios are ratios"});
  all.push_back({"order 0.9", levels(refined(0.1, 2.0, 5), power(0.9)), 1.0, {below}, "exact errors show exactly 0.9"});
  all.push_back({"order 1.1", levels(refined(0.1, 2.0, 5), power(1.1)), 1.0, {above}, "exact errors show exactly 1.1"});
  all.push_back({"order 0.9, uneven ratios", levels(uneven, power(0.9)), 1.0, {below}, "exactly 0.9"});
  all.push_back({"order 1/2 for 1", levels(uneven, power(0.5)), 1.0, {below}, "half of theory's order"});
  all.push_back(
      {"order 1/2 for 1, three levels", levels(refined(0.1, 2.0, 3), power(0.5)), 1.0, {below}, "exactly 1/2"});
  all.push_back({"order 1 for 2", levels(refined(0.1, 2.0, 4), power(1.0)), 2.0, {below}, "half of theory's order"});
  all.push_back(
      {"order 2 for 1", levels(refined(0.1, 2.0, 4), power(2.0)), 1.0, {above}, "superconvergence departs too"});
  all.push_back(
      {"order 3/2 for 1, ratio 1.5", levels(refined(0.1, 1.5, 5), power(1.5)), 1.0, {above}, "superconvergence"});
  all.push_back({"order 76 for 1",
                 {{0.4, 1.0}, {0.3, std::pow(0.75, 76)}, {0.28, std::pow(0.7, 76)}},
                 1.0,
                 {above},
                 "an order of 76 is none of theory's"});
}

void add_two_terms(Entries& all) {
  const std::vector<Verdict> holds = {confirmed, pre_asymptotic};
  for (const double D : {-6.0, -3.9, -1.0, 1.0, 4.0, 9.0}) {
    all.push_back({fmt::format("v (1 {:+} v)", D), levels(refined(0.1, 2.0, 5), two_terms(1.0, D, 1.0)), 1.0, holds,
                   "order 1 in the limit, a correction on the way"});
  }
  for (const double D : {-40.0, 90.0}) {
    all.push_back({fmt::format("v (1 {:+} v^2)", D), levels(refined(0.1, 2.0, 5), two_terms(1.0, D, 2.0)), 1.0, holds,
                   "order 1 in the limit; the correction has another exponent"});
  }
  all.push_back({"v^2 (1 - 3 v), four levels", levels(refined(0.1, 2.0, 4), two_terms(2.0, -3.0, 1.0)), 2.0, holds,
                 "order 2 in the limit"});
  all.push_back({"v^(1/2) (1 + 5 v), uneven ratios", levels(uneven, two_terms(0.5, 5.0, 1.0)), 0.5, holds,
                 "order 1/2 in the limit"});
  all.push_back({"v (1 - 3.9 v), eight levels with 0.3 % noise",
                 noisy(levels(refined(0.1, 2.0, 8), two_terms(1.0, -3.9, 1.0)), 0.003, 11), 1.0, holds,
                 "the noise is small against the correction"});
  all.push_back({"v^0.8 (1 - 3 v) for 1",
                 levels(refined(0.1, 2.0, 4), two_terms(0.8, -3.0, 1.0)),
                 1.0,
                 {below},
                 "the orders rise toward 0.8 and not toward 1"});
  all.push_back({"v^1.2 (1 + 3 v) for 1",
                 levels(refined(0.1, 2.0, 5), two_terms(1.2, 3.0, 1.0)),
                 1.0,
                 {above},
                 "the orders fall toward 1.2 and not toward 1"});
  all.push_back(
      {"v^(1/2) (1 - 3 v) for 1", levels(uneven, two_terms(0.5, -3.0, 1.0)), 1.0, {below}, "order 1/2 in the limit"});
  all.push_back({"v (1 - 3.9 v) for 3/2",
                 levels(refined(0.1, 2.0, 4), two_terms(1.0, -3.9, 1.0)),
                 1.5,
                 {below},
                 "order 1 in the limit"});
  for (const double first : {0.1, 1e-2, 1e-3, 1e-4}) {
    for (const int n : {4, 6}) {
      all.push_back({fmt::format("v log(1/v) from {} on, {} levels", first, n),
                     levels(refined(first, 2.0, n), [](double v) { return v * std::log(1.0 / v); }),
                     1.0,
                     {below, inconclusive},
                     "slower than v, by a factor that no power of v corrects; order 1 only up to a logarithm"});
    }
  }
  all.push_back({"a coarse range without order",
                 {{0.8, 0.5}, {0.4, 0.45}, {0.2, 0.2}, {0.1, 0.1}, {0.05, 0.05}, {0.025, 0.025}, {0.0125, 0.0125}},
                 1.0,
                 holds,
                 "order 1 from the third level on; the two coarsest are not asymptotic"});
}

void add_noise(Entries& all) {
  for (const double percent : {1.0, 2.0, 3.0}) {
    for (const std::uint64_t seed : {1, 2}) {
      all.push_back({fmt::format("order 1, {} % noise, draw {}", percent, seed),
                     noisy(levels(refined(0.1, 2.0, 6), power(1.0)), percent / 100.0, seed),
                     1.0,
                     {confirmed},
                     "a few percent over a factor of 32 leave the order sharp"});
    }
  }
  all.push_back({"order 2, 5 % noise, eight levels",
                 noisy(levels(refined(0.1, 2.0, 8), power(2.0)), 0.05, 3),
                 2.0,
                 {confirmed},
                 "eight levels average the noise"});
  all.push_back({"order 1, 2 % noise, uneven ratios",
                 noisy(levels(uneven, power(1.0)), 0.02, 4),
                 1.0,
                 {confirmed},
                 "a few percent over a factor of 21"});
  for (const std::uint64_t seed : {5, 6}) {
    all.push_back({fmt::format("order 1, 10 % noise, four levels, draw {}", seed),
                   noisy(levels(refined(0.1, 2.0, 4), power(1.0)), 0.1, seed),
                   1.0,
                   {confirmed, inconclusive},
                   "the order is right, but four such levels may not suffice to say so"});
  }
  all.push_back({"order 1/2 for 1, 5 % noise",
                 noisy(levels(refined(0.1, 2.0, 6), power(0.5)), 0.05, 7),
                 1.0,
                 {below},
                 "1/2 away, ten times the scatter"});
  all.push_back({"order 2 for 1, 5 % noise",
                 noisy(levels(refined(0.1, 2.0, 6), power(2.0)), 0.05, 8),
                 1.0,
                 {above},
                 "1 away, twenty times the scatter"});
  const auto oscillating = [](double factor) {
    std::vector<Level> series = levels(refined(0.1, 2.0, 6), power(1.0));
    for (std::size_t i = 1; i < series.size(); i += 2) series[i].error *= factor;
    return series;
  };
  all.push_back({"pairwise orders 1.5, 0.5, 1.5, ...",
                 oscillating(1.0 / std::sqrt(2.0)),
                 1.0,
                 {inconclusive},
                 "a mean of 1 with no level near it"});
  all.push_back({"pairwise orders 0.2, 1.8, 0.2, ...",
                 oscillating(std::pow(2.0, 0.8)),
                 1.0,
                 {inconclusive},
                 "a mean of 1 with no level near it"});
  all.push_back({"pairwise orders 1.02, 0.98, 1.02, ...",
                 oscillating(std::pow(2.0, -0.02)),
                 1.0,
                 {confirmed},
                 "an oscillation within the tolerance"});
}

void add_outliers(Entries& all) {
  const std::vector<Level> clean = levels(refined(0.1, 2.0, 6), power(1.0)),
                           scattered = noisy(levels(refined(0.1, 2.0, 8), power(1.0)), 0.003, 9);
  for (const double factor : {0.67, 1.5}) {
    for (std::size_t level = 0; level < clean.size(); ++level) {
      all.push_back({fmt::format("level {} of 6 off by a factor of {}", level + 1, factor),
                     with_factor(clean, level, factor),
                     1.0,
                     {inconclusive},
                     "five levels agree and one does not"});
    }
    for (const std::size_t level : {std::size_t{0}, std::size_t{3}, std::size_t{7}}) {
      all.push_back({fmt::format("level {} of 8 off by a factor of {}, 0.3 % noise", level + 1, factor),
                     with_factor(scattered, level, factor),
                     1.0,
                     {inconclusive},
                     "far off the scatter of the others"});
    }
  }
}

void add_floors(Entries& all) {
  const auto plateau = [](double p, double floor) { return [=](double v) { return std::pow(v, p) + floor; }; };
  all.push_back({"order 4 down to round-off",
                 levels(refined(0.1, 4.0, 6), plateau(4.0, 3e-14)),
                 4.0,
                 {floor},
                 "the finest errors are round-off",
                 {.scale = 1.0}});
  all.push_back({"zero at the finest level",
                 with_error(levels(refined(0.1, 2.0, 4), power(2.0)), 3, 0.0),
                 2.0,
                 {floor},
                 "no error left to judge"});
  all.push_back({"round-off of a large solution",
                 levels(refined(0.1, 4.0, 6), [](double v) { return 1e6 * std::pow(v, 4.0) + 3e-8; }),
                 4.0,
                 {floor},
                 "3e-8 is round-off where the solution is 1e6",
                 {.scale = 1e6}});
  all.push_back({"small errors of a small solution",
                 levels(refined(0.1, 2.0, 5), [](double v) { return 1e-12 * v; }),
                 1.0,
                 {confirmed},
                 "1e-14 is no round-off where the solution is 1e-6",
                 {.scale = 1e-6}});
  // Errors of a patch test, as a peridynamics code reported them.
  const std::vector<Level> patch = {
      {1.0, 7.1e-15}, {0.5, 4.1e-14}, {0.25, 2.6e-13}, {0.125, 4.5e-13}, {0.0625, 3.2e-12}};
  all.push_back({"round-off that grows, of a solution of size one",
                 patch,
                 1.0,
                 {floor},
                 "1e-12 of the solution",
                 {.scale = 1.0}});
  all.push_back({"round-off that grows, of a solution of unknown size",
                 patch,
                 1.0,
                 {inconclusive, floor},
                 "nothing but the size tells round-off from growth without a law"});
  all.push_back({"order 3 down to 2e-13",
                 levels(refined(0.125, 2.0, 8), [](double v) { return 2.2e-4 * std::pow(v, 3.0); }),
                 3.0,
                 {confirmed},
                 "small errors that fall with an order are no floor"});
  all.push_back({"h^4 + 0.004 h, as theory says that it settles",
                 levels(refined(1.0, 2.0, 4), [](double v) { return std::pow(v, 4.0) + 0.004 * v; }),
                 0.0,
                 {inconclusive, above},
                 "the last pairwise order is 2.74"});
}

void add_settling(Entries& all) {
  const auto plateau = [](double p, double floor) { return [=](double v) { return std::pow(v, p) + floor; }; };
  for (const double height : {1e-9, 1e-3, 0.5}) {
    all.push_back({fmt::format("order 2 down to {}", height),
                   levels(refined(std::sqrt(height) * 8.0, 2.0, 8), plateau(2.0, height)),
                   2.0,
                   {stagnates},
                   "the error stops falling, far above round-off"});
  }
  all.push_back({"order 1 that ends half way",
                 levels(refined(0.8, 2.0, 6), plateau(1.0, 0.05)),
                 1.0,
                 {stagnates},
                 "most of the finest error is a constant"});
  all.push_back({"hardly any order",
                 levels(refined(0.1, 2.0, 4), [](double v) { return 0.01 + 1e-3 * v; }),
                 1.0,
                 {stagnates},
                 "the error is a constant"});
  all.push_back({"settles geometrically, as theory says",
                 levels(refined(1.0, 2.0, 8), plateau(1.0, 0.05)),
                 0.0,
                 {stagnates},
                 "the limit is 0.05"});
  all.push_back({"settles from below, as theory says",
                 levels(refined(1.0, 2.0, 8), [](double v) { return 0.05 - 0.02 * v; }),
                 0.0,
                 {stagnates},
                 "the limit is 0.05"});
  all.push_back({"constant, as theory says",
                 levels(refined(0.1, 2.0, 4), [](double) { return 0.01; }),
                 0.0,
                 {stagnates},
                 "the error is a constant"});
  all.push_back({"constant up to 1 %, as theory says",
                 noisy(levels(refined(0.1, 2.0, 6), [](double) { return 0.01; }), 0.01, 10),
                 0.0,
                 {stagnates},
                 "the error is a constant but for noise"});
  all.push_back({"order 1 where theory says that it settles",
                 levels(refined(0.1, 2.0, 5), power(1.0)),
                 0.0,
                 {inconclusive, above},
                 "the error vanishes"});
  all.push_back({"growth where theory says that it settles",
                 levels(refined(0.1, 2.0, 5), power(-1.0)),
                 0.0,
                 {diverges},
                 "the error doubles at each level"});
}

void add_failures(Entries& all) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const std::vector<Level> clean = levels(refined(0.1, 2.0, 5), power(1.0));
  for (const std::size_t level : {std::size_t{0}, std::size_t{2}, std::size_t{4}}) {
    all.push_back(
        {fmt::format("NaN at level {}", level + 1), with_error(clean, level, nan), 1.0, {unstable}, "a run failed"});
    all.push_back({fmt::format("infinity at level {}", level + 1),
                   with_error(clean, level, infinity),
                   1.0,
                   {unstable},
                   "a run failed"});
    all.push_back({fmt::format("negative at level {}", level + 1),
                   with_error(clean, level, -0.01),
                   1.0,
                   {inconclusive},
                   "this is no error"});
  }
  for (const std::size_t level : {std::size_t{0}, std::size_t{2}}) {
    all.push_back({fmt::format("zero at level {}", level + 1),
                   with_error(clean, level, 0.0),
                   1.0,
                   {inconclusive},
                   "an error that is exactly zero and then is not, is none"});
  }
  all.push_back({"growth like 1/v", levels(refined(0.1, 2.0, 5), power(-1.0)), 1.0, {diverges}, "the error doubles"});
  all.push_back(
      {"growth like v^(-1/4), uneven ratios", levels(uneven, power(-0.25)), 1.0, {diverges}, "the error grows"});
  all.push_back({"falls, then grows",
                 {{0.8, 0.08}, {0.4, 0.04}, {0.2, 0.02}, {0.1, 0.03}, {0.05, 0.05}},
                 1.0,
                 {diverges},
                 "the finest levels grow"});
  all.push_back({"growth like exp(1/v)",
                 levels(refined(0.1, 2.0, 4), [](double v) { return 1e-6 * std::exp(1.0 / v); }),
                 1.0,
                 {unstable},
                 "no power of v grows like this"});
  all.push_back({"explodes at the finest level", with_error(clean, 4, 1e6), 1.0, {unstable}, "a blow-up"});
  all.push_back({"no level", {}, 1.0, {inconclusive}, "no data"});
  all.push_back({"one level", {clean[0]}, 1.0, {inconclusive}, "no order"});
  all.push_back({"two levels", {clean[0], clean[1]}, 1.0, {inconclusive}, "an order without an interval"});
  all.push_back({"three levels on their way",
                 levels(refined(0.1, 2.0, 3), two_terms(1.0, -3.9, 1.0)),
                 1.0,
                 {inconclusive},
                 "three parameters fit any three levels"});
  all.push_back(
      {"a level twice", {clean[0], clean[1], clean[1], clean[2], clean[3]}, 1.0, {inconclusive}, "no refinement"});
  all.push_back({"fine to coarse", {clean.rbegin(), clean.rend()}, 1.0, {inconclusive}, "no refinement"});
  all.push_back(
      {"a variable of zero", {clean[0], clean[1], clean[2], {0.0, 0.001}}, 1.0, {inconclusive}, "no refinement"});
}

}  // namespace

std::vector<CorpusEntry> verdict_corpus() {
  Entries all;
  for (const auto add : {add_powers, add_two_terms, add_noise, add_outliers, add_floors, add_settling, add_failures})
    add(all);
  return all;
}

std::vector<Misjudged> misjudged_by(const Judge& judge) {
  std::vector<Misjudged> wrong;
  for (CorpusEntry& entry : verdict_corpus()) {
    const Verdict verdict = judge(entry);
    if (std::find(entry.right.begin(), entry.right.end(), verdict) == entry.right.end()) {
      wrong.push_back({std::move(entry), verdict});
    }
  }
  return wrong;
}

std::vector<Misjudged> misjudged() {
  return misjudged_by(
      [](const CorpusEntry& entry) { return judge(entry.levels, entry.theory_order, entry.options).verdict; });
}

}  // namespace acstudy
