#pragma once

/// @file
/// Runs the cases of studies in parallel and stores what comes out.

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "studies/cases/study.hpp"
#include "studies/commands/run/shares.hpp"
#include "studies/storing/store.hpp"

namespace acstudy {

struct RunOptions {
  std::filesystem::path out = "reports/out";
  int jobs = 1;                                    ///< cases that run at the same time
  bool fresh = false;                              ///< run stored cases again
  bool readable = false;                           ///< run cases in the readable form of their schemes
  bool quiet = false;                              ///< show no progress
  std::size_t repeats = 1;                         ///< runs of each case, for its time and the spread
  Shard shard = {};                                ///< the share of the work that is done; its results stay in journals
  std::vector<std::filesystem::path> stores = {};  ///< folders whose results are taken up besides those in `out`
  bool merge = false;                              ///< run nothing: what is not stored is an error
  std::string command;
};

struct RunResult {
  std::vector<StudyResult> studies;
  std::vector<double> seconds;  ///< of processors, that each study took; of a case of several their share
  std::size_t computed = 0, reused = 0;
  std::size_t findings = 0;  ///< that were taken, and rest on no cases of their study
  bool interrupted = false;
  bool left_running = false;  ///< what was interrupted goes on in other threads: see done_before_stop()
};

/// Runs every case that is not stored yet, each once even if several studies ask for it, longest first; writes the
/// results of a study as soon as it is complete, and those of incomplete ones when interrupted. Until then what is
/// finished of a study goes to its journal once a second, and a process that is killed loses no more than that.
///
/// Then takes the measurements of studies whose cases are all there. A case and a measurement run in one thread, so
/// numbers do not depend on `jobs`.
/// @param stop  once true, running cases end at their next time step, and whatever takes longer is left behind
/// @throws InputError, before anything is run or written, if results of another study file would be replaced, or if
/// something is missing that is to be merged
/// @throws StoreError, StoreLocked if another process writes these results
RunResult run_studies(const std::vector<Study>& studies, const RunOptions& options, const std::atomic<bool>& stop);

}  // namespace acstudy
