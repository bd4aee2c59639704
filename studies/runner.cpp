#include "studies/runner.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <map>
#include <mutex>
#include <system_error>
#include <thread>
#include <unordered_map>

#include "studies/ensemble/ensemble.hpp"
#include "studies/reference.hpp"

namespace acstudy {

namespace {

/// One distinct case and every place in the studies that wants its result.
struct Job {
  const Case* c;
  struct Place {
    std::size_t study, series, level;
  };
  std::vector<Place> wanted_by;
};

/// Jobs that one call of `run_cases` does: cases on the same particles together, or one by itself.
struct Batch {
  std::vector<std::size_t> jobs;
  double work = 0.0;
};

/// Jobs that share their sweeps, by what they share: particles, then sweeps.
using Sweeps = std::map<std::pair<std::string, std::string>, Batch>;

/// Puts sweeps on the same particles together, up to `most` work a batch. Heaviest batch first.
std::vector<Batch> batches_up_to(double most, const Sweeps& sweeps) {
  std::vector<Batch> batches;
  const std::string* particles = nullptr;
  for (const auto& [key, sweep] : sweeps) {
    const bool joins = particles != nullptr && *particles == key.first && batches.back().work + sweep.work <= most;
    if (!joins) batches.emplace_back();
    batches.back().jobs.insert(batches.back().jobs.end(), sweep.jobs.begin(), sweep.jobs.end());
    batches.back().work += sweep.work;
    particles = &key.first;
  }
  std::stable_sort(batches.begin(), batches.end(), [](const Batch& a, const Batch& b) { return a.work > b.work; });
  return batches;
}

/// The most work that falls to a worker, if whoever is done takes the next batch.
double longest_share(const std::vector<Batch>& batches, int workers) {
  std::vector<double> shares(static_cast<std::size_t>(workers));
  for (const Batch& batch : batches) *std::min_element(shares.begin(), shares.end()) += batch.work;
  return *std::max_element(shares.begin(), shares.end());
}

/// Batches as large as they can be, so that as little as possible is computed twice, and small enough for the workers
/// to end at about the same time.
std::vector<Batch> batches_of(const std::vector<Job>& jobs, int workers) {
  Sweeps sweeps;
  double total = 0.0;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const Case& c = *jobs[i].c;
    const bool vector = runs_in_vector_form(c);
    Batch& batch = sweeps[vector ? std::pair(ensemble_key(c), sweep_key(c)) : std::pair(c.key(), std::string())];
    batch.jobs.push_back(i);
    batch.work += c.estimated_work();
    total += c.estimated_work();
  }
  for (const double parts : {1.0, 2.0}) {
    auto batches = batches_up_to(total / (parts * workers), sweeps);
    if (longest_share(batches, workers) <= 1.03 * total / workers) return batches;
  }
  return batches_up_to(total / (4.0 * workers), sweeps);
}

/// A line on the terminal that is rewritten; silent where stderr is none.
class Progress {
 public:
  Progress(std::size_t jobs, double work) : jobs_(jobs), work_(work), on_terminal_(isatty(STDERR_FILENO) != 0) {}
  ~Progress() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }

  void done(double work) {
    ++finished_;
    finished_work_ += work;
    if (!on_terminal_) return;
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const double left = finished_work_ > 0.0 ? elapsed * (work_ - finished_work_) / finished_work_ : 0.0;
    // fputs and not fmt::print, which throws: a terminal that has gone away must not end the run.
    const std::string line = fmt::format("\r\033[K{} of {} cases, {:.0f} s, about {:.0f} s left", finished_, jobs_,
                                         elapsed, std::ceil(left));
    std::fputs(line.c_str(), stderr);
    std::fflush(stderr);
    shown_ = true;
  }

 private:
  std::size_t jobs_, finished_ = 0;
  double work_, finished_work_ = 0.0;
  bool on_terminal_, shown_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// What the studies' files hold: the cases of all of them together, the findings and the origin of each.
struct Stores {
  std::map<std::string, CaseResult> cases;
  std::vector<StoredCases> each;
};

Stores load_stores(const std::vector<Study>& studies, const RunOptions& options) {
  Stores stores;
  for (const Study& study : studies) {
    StoredCases stored;
    try {
      stored = load_cases(options.out / (study.name + ".h5"));
    } catch (const StoreError&) {
      if (!options.fresh) throw;
    }
    stores.cases.merge(stored.cases);
    stores.each.push_back(std::move(stored));
  }
  return stores;
}

/// Calls `work(i)` for i = 0 .. count-1 from up to `jobs` threads, until one throws or `stop`; what is thrown comes
/// back.
template <class Work>
std::exception_ptr in_parallel(std::size_t count, int jobs, const std::atomic<bool>& stop, Work&& work) {
  std::mutex mutex;
  std::size_t next = 0;
  std::exception_ptr failure;
  const auto worker = [&] {
    for (;;) {
      std::size_t i = 0;
      {
        const std::lock_guard lock(mutex);
        if (next == count || stop || failure) return;
        i = next++;
      }
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        failure = std::current_exception();
      }
    }
  };
  std::vector<std::thread> threads;
  try {
    for (std::size_t t = 1; t < std::min<std::size_t>(jobs, count); ++t) threads.emplace_back(worker);
  } catch (const std::system_error&) {
    // The machine gives no more threads; those that run share the work.
  }
  worker();
  for (std::thread& thread : threads) thread.join();
  return failure;
}

/// The finding of a measurement, or why there is none; what is not the fault of the numbers goes up.
Finding take(const Measurement& measurement, const std::vector<SeriesResult>& results) {
  std::string failure;
  try {
    return measurement.take(results);
  } catch (const StoreError&) {
    throw;
  } catch (const std::domain_error& error) {
    failure = error.what();
  } catch (const std::runtime_error& error) {
    failure = error.what();
  }
  Finding finding{.statement = measurement.name,
                  .test = Test::bounds,
                  .promised = Verdict::holds,
                  .expected = Verdict::holds,
                  .failure = failure};
  judge(finding);
  return finding;
}

}  // namespace

RunResult run_studies(const std::vector<Study>& studies, const RunOptions& options, const std::atomic<bool>& stop) {
  RunResult run;
  const Stores stores = load_stores(studies, options);
  std::vector<Job> jobs;
  std::unordered_map<std::string, std::size_t> job_of;
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
        const auto [entry, is_new] = job_of.try_emplace(key, jobs.size());
        if (is_new) jobs.push_back({&series.cases[i], {}});
        jobs[entry->second].wanted_by.push_back({s, run.studies.back().series.size() - 1, i});
        ++open_cases[s];
      }
    }
    const StoredCases& stored = stores.each[s];
    run.studies[s].findings.resize(study.measurements.size());
    const bool reusable = study.series.empty() && stored.findings_key == findings_key(study) && !options.fresh;
    bool measured = true;
    for (std::size_t i = 0; i < study.measurements.size(); ++i) {
      if (const auto found = stored.findings.find(i); reusable && found != stored.findings.end()) {
        run.studies[s].findings[i] = found->second;
      } else {
        measurements.push_back({s, i});
        measured = false;
      }
    }
    // A study of which nothing is computed keeps the origin of its numbers.
    const bool untouched = open_cases[s] == 0 && measured && !stored.provenance.empty();
    provenance.push_back(untouched ? stored.provenance : collect_provenance(options.jobs, options.command));
  }
  const std::vector<Batch> batches = batches_of(jobs, options.jobs);

  std::vector<bool> finished(studies.size());
  const auto finish = [&](std::size_t s) {
    for (SeriesResult& series : run.studies[s].series) {
      if (series.series->against_reference) compare_with_reference(*series.series, series.results);
      series.judgement = judge_series(*series.series, series.results);
    }
    write_results(options.out, run.studies[s], provenance[s]);
    finished[s] = true;
  };
  const auto finish_if_complete = [&](std::size_t s) {
    const auto& findings = run.studies[s].findings;
    if (open_cases[s] == 0 && std::all_of(findings.begin(), findings.end(), [](const auto& f) { return f; })) finish(s);
  };
  for (std::size_t s = 0; s < studies.size(); ++s) finish_if_complete(s);

  double work = 0.0;
  for (const Job& job : jobs) work += job.c->estimated_work();
  Progress progress(jobs.size(), work);
  std::mutex mutex;
  const auto run_batch = [&](const Batch& batch, int threads) {
    std::vector<const Case*> cases;
    for (const std::size_t i : batch.jobs) cases.push_back(jobs[i].c);
    const std::vector<CaseResult> results = run_cases(cases, stop, options.repeats, threads);
    const std::lock_guard lock(mutex);
    for (std::size_t k = 0; k < results.size(); ++k) {
      if (!results[k].completed) continue;
      const Job& job = jobs[batch.jobs[k]];
      ++run.computed;
      progress.done(job.c->estimated_work());
      for (const auto& place : job.wanted_by) {
        run.studies[place.study].series[place.series].results[place.level] = results[k];
        --open_cases[place.study];
        finish_if_complete(place.study);
      }
    }
  };
  // What alone takes longer than all the rest is shared out to all threads, one batch after the other.
  std::size_t shared = 0;
  std::exception_ptr failure;
  try {
    for (double rest = work; options.jobs > 1 && shared < batches.size() && !stop; ++shared) {
      rest -= batches[shared].work;
      if (batches[shared].work * (options.jobs - 1) <= rest) break;
      run_batch(batches[shared], options.jobs);
    }
  } catch (...) {
    failure = std::current_exception();
  }
  if (!failure) {
    failure = in_parallel(batches.size() - shared, options.jobs, stop,
                          [&](std::size_t i) { run_batch(batches[shared + i], 1); });
  }
  if (!failure && !stop) {
    failure = in_parallel(measurements.size(), options.jobs, stop, [&](std::size_t i) {
      const auto [s, m] = measurements[i];
      const Finding finding = take(studies[s].measurements[m], run.studies[s].series);
      const std::lock_guard lock(mutex);
      run.studies[s].findings[m] = finding;
      finish_if_complete(s);
    });
  }

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
