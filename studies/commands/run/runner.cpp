#include "studies/commands/run/runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <unordered_map>

#include "studies/cases/series_verdict.hpp"
#include "studies/commands/run/batches.hpp"
#include "studies/commands/run/earlier_results.hpp"
#include "studies/commands/run/journals.hpp"
#include "studies/commands/run/parallel.hpp"
#include "studies/commands/run/progress.hpp"
#include "studies/commands/say.hpp"
#include "studies/commands/stop.hpp"
#include "studies/reading/input_error.hpp"
#include "studies/running/reference.hpp"
#include "studies/running/run_case.hpp"
#include "studies/running/stopwatch.hpp"
#include "studies/storing/files.hpp"
#include "studies/storing/keys.hpp"
#include "studies/storing/study_lock.hpp"

namespace acstudy {

namespace {

/// How long cases that are run together may take, in seconds, if some of them can as well be run later.
constexpr double most_seconds = 2.0;

/// What is asked for: each case and each measurement that no earlier run has left.
struct Open {
  /// Where a result of a case is wanted.
  struct Place {
    std::size_t study, series, level;
  };
  std::vector<const Case*> cases;                                 ///< distinct
  std::vector<std::vector<Place>> wanted_by;                      ///< where each of them is wanted
  std::vector<bool> done;                                         ///< whether it is computed
  std::vector<std::size_t> cases_of;                              ///< how many places each study has that are empty
  std::vector<std::vector<std::size_t>> levels_of;                ///< the same of each of its series
  std::vector<std::pair<std::size_t, std::size_t>> measurements;  ///< study, number within it
  std::unordered_map<std::string, std::size_t> index_of;          ///< by storage_key()
};

class Runner {
 public:
  Runner(const std::vector<Study>& studies, const RunOptions& options, const std::atomic<bool>& stop)
      : studies_(studies), options_(options), stop_(stop), shares_(studies, options.shard.count) {
    earlier_ = earlier_results(studies, options);
    for (std::size_t s = 0; s < studies.size(); ++s) take_up(s);
    // What is kept is for levels that are added later.
    const auto adds_levels = [](const Study& study) {
      return std::any_of(study.series.begin(), study.series.end(), [](const Series& s) { return s.until_decided; });
    };
    if (std::none_of(studies.begin(), studies.end(), adds_levels)) earlier_ = {};
    if (options.merge) require_nothing_open();
    journals_.emplace(options.out, options.shard.suffix(), run_.studies, mutex_);
    plans_ = plan(open_.cases);
  }

  RunResult run() {
    for (std::size_t s = 0; s < studies_.size(); ++s) finish_if_complete(s);
    start_progress();
    {
      const EverySecond every_second([&] {
        progress_->show();
        journals_->save();
      });
      run_.left_running = !done_before_stop(stop_, [&] {
        std::exception_ptr failure = run_batches();
        if (!failure && !stop_) failure = take_measurements();
        failure_ = failure;
      });
    }
    const std::exception_ptr unsaved = options_.shard.whole() ? nullptr : journals_->save();
    // What is left running waits for this lock at its end, and that of the program.
    auto* const lock = new std::unique_lock(mutex_);
    std::exception_ptr failure = run_.left_running || failure_ == nullptr ? unsaved : failure_;
    progress_.reset();
    // What is done is stored before anything is said of what went wrong.
    run_.interrupted = stop_;
    for (std::size_t s = 0; s < studies_.size() && options_.shard.whole(); ++s) {
      if (journals_->finished(s)) continue;
      try {
        finish(s);
      } catch (...) {
        if (!failure) failure = std::current_exception();
      }
    }
    if (!run_.left_running) delete lock;
    if (failure) std::rethrow_exception(failure);
    return std::move(run_);
  }

 private:
  /// Takes what is there of a study, and asks for the rest.
  void take_up(std::size_t s) {
    const Study& study = studies_[s];
    StudyResult& result = run_.studies.emplace_back(StudyResult{&study, {}, {}});
    run_.seconds.push_back(0.0);
    open_.cases_of.push_back(0);
    open_.levels_of.emplace_back(study.series.size(), 0);
    for (const Series& series : study.series) {
      const std::size_t number = result.series.size();
      result.series.push_back({&series, {}});
      result.series.back().results.reserve(series.cases.size());  // journals point to results
      for (std::size_t i = 0; i < series.cases_at_first(); ++i) take_up_level(s, number);
      add_levels(s, number);
    }
    const StoredCases& stored = earlier_.each[s];
    result.findings.resize(study.measurements.size());
    const bool reusable = open_.cases_of[s] == 0 && stored.findings_key == findings_key(study) && !options_.fresh;
    bool measured = true;
    for (std::size_t i = 0; i < study.measurements.size(); ++i) {
      if (study.measurements[i].check.series) continue;  // taken whenever the study is written, be it interrupted
      if (const auto found = stored.findings.find(i); reusable && found != stored.findings.end()) {
        result.findings[i] = found->second;
        // The store has their values, but not what a reader sees of them.
        result.findings[i]->coordinates = study.measurements[i].check.coordinates;
      } else {
        measured = false;
        const int share = shares_.of(s, i);
        if (options_.shard.whole() || share == options_.shard.number) open_.measurements.push_back({s, i});
      }
    }
    // A study of which nothing is computed keeps the origin of its numbers.
    const bool untouched = open_.cases_of[s] == 0 && measured && !stored.provenance.empty();
    provenance_.push_back(untouched ? stored.provenance : collect_provenance(options_.jobs, options_.command));
    stands_.push_back(untouched && results_stand(options_.out, stored, study));
  }

  /// What is to be merged is all there.
  void require_nothing_open() const {
    for (std::size_t s = 0; s < studies_.size(); ++s) {
      const auto findings = std::count_if(open_.measurements.begin(), open_.measurements.end(), [&](const auto& one) {
        return one.first == s && shares_.of(one.first, one.second) != 0;
      });
      if (open_.cases_of[s] == 0 && findings == 0) continue;
      const std::string first =
          open_.cases.empty() ? "" : fmt::format(", the first with N = {}", open_.cases.front()->N);
      throw InputError(fmt::format(
          "{}: {} cases and {} findings of study \"{}\" are stored in none of the folders{}; a share was not run to "
          "its "
          "end, or by another build or another kind of processor: run it, or let acstudy run {} --out {} do the rest",
          studies_[s].file, open_.cases_of[s], findings, studies_[s].name, first, studies_[s].file,
          options_.out.string()));
    }
  }

  /// The next level of a series; true if it is a case that nobody has asked for.
  bool take_up_level(std::size_t s, std::size_t number) {
    std::vector<CaseResult>& results = run_.studies[s].series[number].results;
    const Open::Place place{s, number, results.size()};
    results.emplace_back();
    const Case& c = studies_[s].series[number].cases[place.level];
    const std::string key = storage_key(c);
    if (const auto found = earlier_.cases.find(key); found != earlier_.cases.end()) {
      // With --fresh it stands until the new result is there, so that an interruption loses nothing.
      result_at(place) = found->second;
      // What kept a program from its work may be gone, and a limit be another, or a machine less busy.
      const std::string& failure = found->second.failure;
      const bool again = options_.fresh || failure.starts_with(over_limit) || failure.starts_with(over_memory) ||
                         (c.scheme.program != nullptr && !failure.empty());
      if (!again) {
        ++run_.reused;
        return false;
      }
    }
    if (shares_.of(c) != options_.shard.number && !options_.shard.whole()) return false;
    const auto [entry, is_new] = open_.index_of.try_emplace(key, open_.cases.size());
    if (is_new) {
      open_.cases.push_back(&c);
      open_.wanted_by.emplace_back();
      open_.done.push_back(false);
    } else if (open_.done[entry->second]) {
      result_at(place) = result_at(open_.wanted_by[entry->second].front());
      ++run_.reused;
      return false;
    } else if (c.limit > open_.cases[entry->second]->limit) {
      open_.cases[entry->second] = &c;  // the same numbers, with more time for them
    }
    open_.wanted_by[entry->second].push_back(place);
    ++open_.cases_of[s];
    ++open_.levels_of[s][number];
    return is_new;
  }

  /// Where levels are added until they decide: those that it takes beyond the ones that are there, up to one that has
  /// to be run. The next is asked for when that is done, so what is run depends on results alone. True for a new case.
  bool add_levels(std::size_t s, std::size_t number) {
    const Series& series = studies_[s].series[number];
    const std::vector<CaseResult>& results = run_.studies[s].series[number].results;
    if (!series.until_decided) return false;
    if (!options_.shard.whole() && shares_.of(series.cases.front()) != options_.shard.number) return false;
    const auto& verdict =
        *std::find_if(studies_[s].measurements.begin(), studies_[s].measurements.end(),
                      [&](const Measurement& measurement) { return measurement.check.series == number; });
    while (results.size() < series.cases.size() && open_.levels_of[s][number] == 0 &&
           !is_decided(verdict.take(run_.studies[s].series))) {
      if (take_up_level(s, number)) return true;
    }
    return false;
  }

  /// The same while batches run.
  void add_levels_in_run(std::size_t s, std::size_t number) {
    if (!add_levels(s, number)) return;
    const Case& added = *open_.cases.back();
    plans_.push_back(plan(added));
    batches_.push_front({{plans_.size() - 1}, added.estimated_work()});
    progress_->case_added(added.estimated_work(), {s});
    changed_.notify_all();
  }

  /// The studies that want an open case, each once.
  std::vector<std::size_t> wanting(std::size_t open_case) const {
    std::vector<std::size_t> studies;  // their numbers do not fall
    for (const Open::Place& place : open_.wanted_by[open_case]) {
      if (studies.empty() || studies.back() != place.study) studies.push_back(place.study);
    }
    return studies;
  }

  void start_progress() {
    std::vector<StudyPace> studies;
    for (const Study& study : studies_) studies.push_back({study.name});
    Pace all{.cases = open_.cases.size(), .findings = open_.measurements.size()};
    for (std::size_t i = 0; i < open_.cases.size(); ++i) {
      const double work = open_.cases[i]->estimated_work();
      all.work += work;
      for (const std::size_t s : wanting(i)) {
        ++studies[s].pace.cases;
        studies[s].pace.work += work;
      }
    }
    for (const auto& [s, number] : open_.measurements) ++studies[s].pace.findings;
    progress_.emplace(std::move(studies), all, options_.quiet);
  }

  CaseResult& result_at(const Open::Place& place) {
    return run_.studies[place.study].series[place.series].results[place.level];
  }

  void finish(std::size_t s) {
    for (SeriesResult& series : run_.studies[s].series) {
      if (series.series->against_reference) compare_with_reference(*series.series, series.results);
    }
    for (std::size_t i = 0; i < studies_[s].measurements.size(); ++i) {
      const Measurement& measurement = studies_[s].measurements[i];
      if (measurement.check.series) run_.studies[s].findings[i] = measurement.take(run_.studies[s].series);
    }
    if (!stands_[s]) write_results(options_.out, run_.studies[s], provenance_[s]);
    journals_->finish(s);
    if (progress_) progress_->study_done(s, run_.seconds[s]);
  }

  void finish_if_complete(std::size_t s) {
    if (!options_.shard.whole()) return;  // the rest is others'
    const auto& findings = run_.studies[s].findings;
    const auto& planned = studies_[s].measurements;
    const bool complete = std::equal(planned.begin(), planned.end(), findings.begin(),
                                     [](const auto& one, const auto& f) { return one.check.series || f; });
    if (open_.cases_of[s] == 0 && complete) finish(s);
  }

  /// All cases; what comes back is what was thrown.
  std::exception_ptr run_batches() {
    for (Batch& batch : batches_of(plans_, options_.jobs)) batches_.push_back(std::move(batch));
    // What alone takes longer than all the rest is shared out to all threads, one batch after the other.
    try {
      std::unique_lock lock(mutex_);
      const auto shares = [&](const Batch& batch) { return plans_[batch.cases.front()].form->together; };
      while (options_.jobs > 1 && !batches_.empty() && shares(batches_.front()) && !stop_) {
        double rest = 0.0;
        for (const Batch& batch : batches_) rest += batch.work;
        const double longest = batches_.front().work;
        if (longest * (options_.jobs - 1) <= rest - longest) break;
        run_batch(lock, options_.jobs);
      }
    } catch (...) {
      return std::current_exception();
    }
    return in_parallel(std::min<std::size_t>(options_.jobs, open_.cases.size()), [&] {
      std::unique_lock lock(mutex_);
      // A batch that runs may put cases off.
      changed_.wait(lock, [&] { return !batches_.empty() || running_ == 0; });
      if (batches_.empty() || stop_) return false;
      run_batch(lock, 1);
      return true;
    });
  }

  void run_batch(std::unique_lock<std::mutex>& lock, int threads) {
    const Batch batch = std::move(batches_.front());
    batches_.pop_front();
    ++running_;
    std::vector<Plan> these;
    for (const std::size_t i : batch.cases) these.push_back(plans_[i]);
    lock.unlock();
    std::vector<CaseResult> results;
    std::exception_ptr failure;
    double seconds = 0.0;
    try {
      timed(seconds, [&] { results = run_cases(these, stop_, options_.repeats, threads, most_seconds); });
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    --running_;
    changed_.notify_all();
    if (failure) std::rethrow_exception(failure);
    take_results(batch, std::move(results), threads * seconds);
  }

  /// Takes results of a batch; what was put off of it is open again, in parts of what was done.
  /// @param seconds  of processors, for all of them
  void take_results(const Batch& batch, std::vector<CaseResult> results, double seconds) {
    double done = 0.0;
    for (std::size_t k = 0; k < results.size(); ++k) {
      if (results[k].completed) done += open_.cases[batch.cases[k]]->estimated_work();
    }
    std::vector<std::size_t> put_off;
    for (std::size_t k = 0; k < results.size(); ++k) {
      const std::size_t i = batch.cases[k];
      if (!results[k].completed) {
        put_off.push_back(i);
        continue;
      }
      ++run_.computed;
      const double work = open_.cases[i]->estimated_work();
      const std::vector<std::size_t> studies = wanting(i);
      progress_->case_done(work, studies);
      std::set<std::size_t> unsaved;
      open_.done[i] = true;
      const std::vector<Open::Place> places = open_.wanted_by[i];
      for (const Open::Place& place : places) {
        CaseResult& result = result_at(place);
        result = results[k];
        if (unsaved.insert(place.study).second) {
          journals_->unsaved(place.study).cases.emplace_back(open_.cases[i], &result);
        }
        --open_.cases_of[place.study];
        --open_.levels_of[place.study][place.series];
      }
      for (const Open::Place& place : places) add_levels_in_run(place.study, place.series);
      for (const std::size_t s : studies) {
        run_.seconds[s] += seconds * work / done / static_cast<double>(studies.size());
        finish_if_complete(s);
      }
    }
    if (stop_) return;
    std::vector<Batch> parts = batches_up_to(done, plans_, put_off);
    for (auto part = parts.rbegin(); part != parts.rend(); ++part) batches_.push_front(std::move(*part));
  }

  std::exception_ptr take_measurements() {
    std::size_t next = 0;
    return in_parallel(std::min<std::size_t>(options_.jobs, open_.measurements.size()), [&] {
      std::unique_lock lock(mutex_);
      if (next == open_.measurements.size() || stop_) return false;
      const auto [s, m] = open_.measurements[next++];
      lock.unlock();
      Finding finding;
      double seconds = 0.0;
      timed(seconds, [&] { finding = studies_[s].measurements[m].take(run_.studies[s].series); });
      lock.lock();
      run_.studies[s].findings[m] = std::move(finding);
      ++run_.findings;
      run_.seconds[s] += seconds;
      journals_->unsaved(s).findings.push_back(m);
      progress_->finding_done(s);
      finish_if_complete(s);
      return true;
    });
  }

  const std::vector<Study>& studies_;
  const RunOptions& options_;
  const std::atomic<bool>& stop_;
  Shares shares_;
  RunResult run_;
  Open open_;
  std::exception_ptr failure_;  ///< of what is computed
  EarlierResults earlier_;
  std::vector<Plan> plans_;  ///< of the open cases
  std::vector<Provenance> provenance_;
  std::vector<bool> stands_;  ///< what is stored of a study is what would be
  std::mutex mutex_;          ///< for results, journals and batches, and for HDF5
  std::optional<Journals> journals_;
  std::optional<Progress> progress_;
  std::deque<Batch> batches_;  ///< heaviest first
  int running_ = 0;            ///< batches
  std::condition_variable changed_;
};

}  // namespace

namespace {

/// Keeps others from writing the results of these studies.
std::vector<StudyLock> locks_of(const std::vector<Study>& studies, const RunOptions& options) {
  std::vector<StudyLock> locks;
  std::set<std::string> files;
  bool said = false;
  for (const Study& study : studies) {
    const std::string& name = study.name;
    locks.emplace_back(options.out, name + options.shard.suffix());
    if (const std::string& why = locks.back().without(); !why.empty() && !std::exchange(said, true)) {
      say(fmt::format("note: {}: this file system has no locks ({}); see that no other run writes there",
                      options.out.string(), why));
    }
    if (!options.shard.whole()) {
      require_unlocked(options.out, name);
      continue;
    }
    for (const char* const extension : {".h5", ".json"}) files.insert(name + extension);
    for (const auto& folder : options.stores) require_no_writer(folder, name);
    require_no_writer(options.out, name, &locks.back());
  }
  if (options.shard.whole()) remove_partial(options.out, files);
  return locks;
}

}  // namespace

RunResult run_studies(const std::vector<Study>& studies, const RunOptions& options, const std::atomic<bool>& stop) {
  const std::vector<StudyLock> locks = locks_of(studies, options);
  auto runner = std::make_unique<Runner>(studies, options, stop);
  RunResult result = runner->run();
  if (result.left_running) static_cast<void>(runner.release());  // its threads use it to the end of the program
  return result;
}

}  // namespace acstudy
