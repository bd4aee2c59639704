#pragma once

/// @file
/// Cases and series that are timed.

#include <cstdint>
#include <vector>

#include "studies/cases/case_result.hpp"
#include "studies/cases/study.hpp"

namespace acstudy {

/// One timed run of a case, and the parts of its time.
struct Sample : PartSeconds {
  std::int64_t round = 0;    ///< counted from 1; in a round every case that needs another run has one
  std::int64_t session = 0;  ///< counted from 1; a bench that was interrupted has several
  double seconds = 0.0;      ///< of the whole time loop

  template <class Record, class Visit>
  static void stored(Record& r, Visit&& visit) {
    visit(Stored{"round"}, r.round);
    visit(Stored{"session"}, r.session);
    visit(Stored{.name = "seconds", .timed = true}, r.seconds);
    PartSeconds::stored(r, visit);
  }
};

/// A case with a number of threads, what came out, and its samples.
struct BenchCase {
  const Case* c = nullptr;
  int threads = 1;
  CaseResult result;  ///< of the first run, without fields; its times are not those of the samples
  std::vector<Sample> samples;

  /// One that has no solution is not timed.
  bool timed() const { return result.failure.empty() && result.blow_up.empty(); }
  double total_seconds() const;
};

/// A series of a study: its cases as indices of the bench's.
struct BenchSeries {
  const Study* study;
  const Series* series;
  int threads;
  std::vector<std::size_t> cases;
};

struct Bench {
  std::vector<BenchCase> cases;  ///< distinct
  std::vector<BenchSeries> series;
};

struct BenchOptions {
  std::int64_t runs = 5;       ///< least number of timed runs of a case
  double least_seconds = 0.2;  ///< least time of these in all; `most_runs` do, however short they are
  std::vector<int> threads = {1};
};

/// Median, minimum and median absolute deviation from the median.
struct Spread {
  double median, minimum, deviation;
};
/// @pre values are not empty
Spread spread_of(std::vector<double> values);

}  // namespace acstudy
