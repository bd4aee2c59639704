#include "studies/commands/run/runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <system_error>
#include <thread>
#include <unordered_map>

#include "studies/commands/run/batches.hpp"
#include "studies/commands/run/progress.hpp"
#include "studies/reading/input_error.hpp"
#include "studies/running/reference.hpp"
#include "studies/running/run_case.hpp"
#include "studies/storing/files.hpp"
#include "studies/storing/journal.hpp"
#include "studies/storing/keys.hpp"
#include "studies/storing/store_error.hpp"

namespace acstudy {

namespace {

/// Where a result of a case is wanted.
struct Place {
  std::size_t study, series, level;
};

/// How long cases that are run together may take, in seconds, if some of them can as well be run later.
constexpr double most_seconds = 2.0;

/// What the studies' files hold: the cases of all of them together, the findings and the origin of each.
struct Stores {
  std::map<std::string, CaseResult> cases;
  std::vector<StoredCases> each;
};

/// Throws if results would be lost that belong to another study file. A file that was moved or copied as it is does as
/// well as the one that it comes from.
void require_own_results(const Study& study, const StoredCases& stored, const std::filesystem::path& out) {
  if (stored.study_file.empty() || stored.study_file == absolute_path(study.file) || stored.study_text == study.text) {
    return;
  }
  const std::filesystem::path result = out / (study.name + ".h5");
  throw InputError(
      fmt::format("{}: study \"{}\" would replace the results of {}, a study of the same name, in {}; name another "
                  "folder with --out, give it another name, or remove these results",
                  study.file, study.name, stored.study_file, result.string()));
}

Stores load_stores(const std::vector<Study>& studies, const RunOptions& options) {
  Stores stores;
  for (const Study& study : studies) {
    StoredCases stored;
    try {
      stored = load_cases(options.out / (study.name + ".h5"));
    } catch (const StoreLocked&) {
      throw;
    } catch (const StoreError&) {
      if (!options.fresh) throw;
    }
    require_own_results(study, stored, options.out);
    stores.cases.merge(stored.cases);
    stores.each.push_back(std::move(stored));
  }
  return stores;
}

/// Calls `work()` from so many threads, again and again until it returns false or throws in one of them; what is
/// thrown comes back. Where there is nothing to do for now, but may be later, `work` waits.
template <class Work>
std::exception_ptr in_parallel(std::size_t count, Work&& work) {
  std::mutex mutex;
  std::exception_ptr failure;
  const auto worker = [&] {
    for (;;) {
      {
        const std::lock_guard lock(mutex);
        if (failure) return;
      }
      try {
        if (!work()) return;
      } catch (...) {
        const std::lock_guard lock(mutex);
        failure = std::current_exception();
      }
    }
  };
  std::vector<std::thread> threads;
  try {
    for (std::size_t t = 1; t < count; ++t) threads.emplace_back(worker);
  } catch (const std::system_error&) {
    // The machine gives no more threads; those that run share the work.
  }
  worker();
  for (std::thread& thread : threads) thread.join();
  return failure;
}

/// Appends what is not saved yet to the journals. A disk that is full now may not be later, and the run goes on.
void save(const std::filesystem::path& out, const std::vector<StudyResult>& studies, std::vector<Finished>& unsaved,
          const std::vector<bool>& finished, std::mutex& mutex) {
  for (std::size_t s = 0; s < studies.size(); ++s) {
    const std::filesystem::path journal = journal_path(out, studies[s].study->name);
    Finished saved;
    try {
      std::vector<char> record;
      {
        const std::lock_guard lock(mutex);
        if (unsaved[s].empty()) continue;
        record = journal_record(studies[s], unsaved[s]);
        std::swap(saved, unsaved[s]);
      }
      append_to_journal(journal, record);
      saved = {};
    } catch (const std::exception&) {
      // What cannot be saved is tried again a second later; the end of the run says why if that fails, too.
    }
    const std::lock_guard lock(mutex);
    if (finished[s]) {
      std::error_code ignored;
      std::filesystem::remove(journal, ignored);
    } else {
      unsaved[s].cases.insert(unsaved[s].cases.end(), saved.cases.begin(), saved.cases.end());
      unsaved[s].findings.insert(unsaved[s].findings.end(), saved.findings.begin(), saved.findings.end());
    }
  }
}

}  // namespace

RunResult run_studies(const std::vector<Study>& studies, const RunOptions& options, const std::atomic<bool>& stop) {
  RunResult run;
  const Stores stores = load_stores(studies, options);
  std::vector<const Case*> cases;             // each distinct one that is to be run
  std::vector<std::vector<Place>> wanted_by;  // where each of them is wanted
  std::unordered_map<std::string, std::size_t> index_of;
  std::vector<std::size_t> open_cases;
  std::vector<Provenance> provenance;
  std::vector<std::pair<std::size_t, std::size_t>> measurements;  // study, number within it
  for (std::size_t s = 0; s < studies.size(); ++s) {
    const Study& study = studies[s];
    run.studies.push_back({&study, {}, {}});
    open_cases.push_back(0);
    for (const Series& series : study.series) {
      auto& results = run.studies.back().series.emplace_back(SeriesResult{&series, {}, {}}).results;
      results.resize(series.cases.size());
      for (std::size_t i = 0; i < series.cases.size(); ++i) {
        const std::string key = storage_key(series.cases[i]);
        if (const auto found = stores.cases.find(key); found != stores.cases.end()) {
          // With --fresh it stands until the new result is there, so that an interruption loses nothing.
          results[i] = found->second;
          if (!options.fresh) {
            ++run.reused;
            continue;
          }
        }
        const auto [entry, is_new] = index_of.try_emplace(key, cases.size());
        if (is_new) {
          cases.push_back(&series.cases[i]);
          wanted_by.emplace_back();
        }
        wanted_by[entry->second].push_back({s, run.studies.back().series.size() - 1, i});
        ++open_cases[s];
      }
    }
    const StoredCases& stored = stores.each[s];
    run.studies[s].findings.resize(study.measurements.size());
    const bool reusable = open_cases[s] == 0 && stored.findings_key == findings_key(study) && !options.fresh;
    bool measured = true;
    for (std::size_t i = 0; i < study.measurements.size(); ++i) {
      if (const auto found = stored.findings.find(i); reusable && found != stored.findings.end()) {
        run.studies[s].findings[i] = found->second;
        // The store has their values, but not what a reader sees of them.
        run.studies[s].findings[i]->coordinates = study.measurements[i].check.coordinates;
      } else {
        measurements.push_back({s, i});
        measured = false;
      }
    }
    // A study of which nothing is computed keeps the origin of its numbers.
    const bool untouched = open_cases[s] == 0 && measured && !stored.provenance.empty();
    provenance.push_back(untouched ? stored.provenance : collect_provenance(options.jobs, options.command));
  }

  std::vector<Finished> unsaved(studies.size());
  std::vector<bool> finished(studies.size());
  const auto finish = [&](std::size_t s) {
    for (SeriesResult& series : run.studies[s].series) {
      if (series.series->against_reference) compare_with_reference(*series.series, series.results);
      series.judgement = judge_series(*series.series, series.results);
    }
    write_results(options.out, run.studies[s], provenance[s]);
    finished[s] = true;
    unsaved[s] = {};
  };
  const auto finish_if_complete = [&](std::size_t s) {
    const auto& findings = run.studies[s].findings;
    if (open_cases[s] == 0 && std::all_of(findings.begin(), findings.end(), [](const auto& f) { return f; })) finish(s);
  };
  for (std::size_t s = 0; s < studies.size(); ++s) finish_if_complete(s);

  double work = 0.0;
  for (const Case* c : cases) work += c->estimated_work();
  std::mutex mutex;  // for all that follows, and for HDF5
  Progress progress(cases.size(), work, measurements.size());
  std::optional<EverySecond> every_second([&] {
    progress.show();
    save(options.out, run.studies, unsaved, finished, mutex);
  });

  std::deque<Batch> open_batches;  // heaviest first
  for (Batch& batch : batches_of(cases, options.jobs)) open_batches.push_back(std::move(batch));
  int running = 0;
  std::condition_variable changed;
  // Takes results of a batch; what was put off of it is open again, in parts of what was done.
  const auto take_results = [&](const Batch& batch, std::vector<CaseResult> results) {
    double done = 0.0;
    std::vector<std::size_t> put_off;
    for (std::size_t k = 0; k < results.size(); ++k) {
      const std::size_t i = batch.cases[k];
      if (!results[k].completed) {
        put_off.push_back(i);
        continue;
      }
      ++run.computed;
      done += cases[i]->estimated_work();
      progress.case_done(cases[i]->estimated_work());
      std::set<std::size_t> wanting;
      for (const Place& place : wanted_by[i]) {
        CaseResult& result = run.studies[place.study].series[place.series].results[place.level];
        result = results[k];
        if (wanting.insert(place.study).second) unsaved[place.study].cases.emplace_back(cases[i], &result);
        --open_cases[place.study];
      }
      for (const std::size_t s : wanting) finish_if_complete(s);
    }
    if (stop) return;
    std::vector<Batch> parts = batches_up_to(done, cases, put_off);
    for (auto part = parts.rbegin(); part != parts.rend(); ++part) open_batches.push_front(std::move(*part));
  };
  const auto run_batch = [&](std::unique_lock<std::mutex>& lock, int threads) {
    const Batch batch = std::move(open_batches.front());
    open_batches.pop_front();
    ++running;
    lock.unlock();
    std::vector<const Case*> these;
    for (const std::size_t i : batch.cases) these.push_back(cases[i]);
    std::vector<CaseResult> results;
    std::exception_ptr failure;
    try {
      results = run_cases(these, stop, options.repeats, threads, most_seconds);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    --running;
    changed.notify_all();
    if (failure) std::rethrow_exception(failure);
    take_results(batch, std::move(results));
  };

  // What alone takes longer than all the rest is shared out to all threads, one batch after the other.
  std::exception_ptr failure;
  try {
    std::unique_lock lock(mutex);
    while (options.jobs > 1 && !open_batches.empty() && !stop) {
      double rest = 0.0;
      for (const Batch& batch : open_batches) rest += batch.work;
      const double longest = open_batches.front().work;
      if (longest * (options.jobs - 1) <= rest - longest) break;
      run_batch(lock, options.jobs);
    }
  } catch (...) {
    failure = std::current_exception();
  }
  if (!failure) {
    failure = in_parallel(std::min<std::size_t>(options.jobs, cases.size()), [&] {
      std::unique_lock lock(mutex);
      // A batch that runs may put cases off.
      changed.wait(lock, [&] { return !open_batches.empty() || running == 0; });
      if (open_batches.empty() || stop) return false;
      run_batch(lock, 1);
      return true;
    });
  }
  if (!failure && !stop) {
    std::size_t next = 0;
    failure = in_parallel(std::min<std::size_t>(options.jobs, measurements.size()), [&] {
      std::unique_lock lock(mutex);
      if (next == measurements.size() || stop) return false;
      const auto [s, m] = measurements[next++];
      lock.unlock();
      Finding finding = studies[s].measurements[m].take(run.studies[s].series);
      lock.lock();
      run.studies[s].findings[m] = std::move(finding);
      unsaved[s].findings.push_back(m);
      progress.finding_done();
      finish_if_complete(s);
      return true;
    });
  }
  every_second.reset();

  // What is done is stored before anything is said of what went wrong.
  run.interrupted = stop;
  for (std::size_t s = 0; s < studies.size(); ++s) {
    if (finished[s]) continue;
    try {
      finish(s);
    } catch (...) {
      if (!failure) failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
  return run;
}

}  // namespace acstudy
