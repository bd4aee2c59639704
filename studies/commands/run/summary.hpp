#pragma once

/// @file
/// What a run says at its end, in a few lines for any number of studies.

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "studies/commands/gate.hpp"
#include "studies/commands/run/runner.hpp"

namespace acstudy {

/// What came of the studies of a run.
struct RunSummary {
  std::vector<Row> rows;                        ///< those that a reader wants one by one: of series, or departing
  std::map<std::string, std::size_t> verdicts;  ///< how many findings have each, those without a row too
  int status = 0;                               ///< the exit code that they make

  std::size_t studies = 0, computed = 0, reused = 0;
  double seconds = 0.0;                                  ///< from its start to its end
  std::vector<std::pair<std::string, double>> by_study;  ///< seconds of processors
  std::string out;                                       ///< folder of the results
};

/// @param seconds  from the start of the run to its end
RunSummary summarize(const RunResult& result, double seconds, const std::string& out);

/// Departures, in full as far as they fit, then counts by verdict, the slowest studies, and where results are.
/// @param width  characters of a line, unless a word has more
/// @param most   lines
std::string summary_text(const RunSummary& summary, std::size_t width, std::size_t most);

/// The departures alone, as far as they fit; empty if there is none.
std::string departures_text(const RunSummary& summary, std::size_t width, std::size_t most);

/// A line per study whose steps went beyond the bound of their lemma, and by how much; the first `most` of them, and
/// how many there are besides. Steps that follow the rows' bound, or a tolerance, mean to, and are none of them.
std::vector<std::string> steps_beyond_bounds(const std::vector<StudyResult>& studies, std::size_t most);

/// A line per series of adaptive steps: how many its cases took, and took back.
std::string adaptive_steps_text(const std::vector<StudyResult>& studies);

}  // namespace acstudy
