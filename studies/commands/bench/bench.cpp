#include "studies/commands/bench/bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <vector>

#include "studies/reading/input_error.hpp"
#include "studies/storing/bench_store.hpp"

namespace acstudy {

namespace {

std::string name_of(const BenchCase& one) {
  return fmt::format("{}, delta = {:.6g}, N = {}", scheme_label(one.c->scheme, one.c->scene->standing()), one.c->delta,
                     one.c->N);
}

/// What differs between two results of one case although nothing may; empty if nothing does.
std::string difference(const CaseResult& first, const CaseResult& now) {
  std::vector<std::string> before;
  std::string found;
  const auto exact = []<class T>(const T& value) {  // texts are equal exactly if values are
    if constexpr (std::is_same_v<T, double>) return fmt::format("{:.17g}", value);
    if constexpr (!is_field<T>) return fmt::format("{}", value);
    return std::string();  // fields are dropped
  };
  CaseResult::stored(first, [&](const Stored&, const auto& value) { before.push_back(exact(value)); });
  std::size_t i = 0;
  CaseResult::stored(now, [&]<class T>(const Stored& as, const T& value) {
    const std::string was = before[i++], is = exact(value);
    if (!found.empty() || as.timed || is == was) return;
    std::string name = as.name;
    std::replace(name.begin(), name.end(), '_', ' ');
    found = std::is_integral_v<T> ? fmt::format("it had {} {} and then {}", was, name, is)
                                  : fmt::format("its {} was {} and then {}", name, was, is);
  });
  return found;
}

void drop_fields(CaseResult& result) {
  CaseResult::stored(result, []<class T>(const Stored&, T& value) {
    if constexpr (is_field<T>) value = {};
  });
}

}  // namespace

Bench plan_bench(std::span<const Study> studies, const std::vector<int>& threads) {
  Bench bench;
  std::unordered_map<std::string, std::size_t> index_of;
  for (const Study& study : studies) {
    const auto of_series = [](const Measurement& measurement) { return measurement.check.series.has_value(); };
    if (!std::all_of(study.measurements.begin(), study.measurements.end(), of_series)) {
      throw InputError(fmt::format("{}: kind = \"{}\"; bench times the runs of convergence studies, so leave it out",
                                   study.file, study.kind));
    }
    if (!study.scene->solved()) {
      throw InputError(fmt::format(
          "{}: bench sets run times against errors, and this scene has a reference in place of u", study.file));
    }
    for (const Series& series : study.series) {
      for (const int count : threads) {
        BenchSeries& planned = bench.series.emplace_back(BenchSeries{&study, &series, count, {}});
        for (const Case& c : std::span(series.cases).first(series.cases_at_first())) {
          const BenchCase one{.c = &c, .threads = count, .form = {}, .result = {}, .samples = {}};
          const auto [entry, is_new] = index_of.try_emplace(bench_key(one), bench.cases.size());
          if (is_new) bench.cases.push_back(one);
          planned.cases.push_back(entry->second);
        }
      }
    }
  }
  return bench;
}

BenchOutcome time_cases(Bench& bench, const BenchOptions& options, const BenchHooks& hooks,
                        const std::atomic<bool>& stop) {
  BenchOutcome outcome;
  std::int64_t round = 0, session = 0;
  for (const BenchCase& one : bench.cases) {
    for (const Sample& sample : one.samples) {
      round = std::max(round, sample.round);
      session = std::max(session, sample.session);
    }
  }
  ++session;
  const auto needs_more = [&](const BenchCase& one) {
    const std::int64_t runs = std::ssize(one.samples);
    return one.timed() && (runs < options.runs || (runs < most_runs && one.total_seconds() < options.least_seconds));
  };
  /// False once the bench has to end.
  const auto run = [&](BenchCase& one, CaseResult& now) {
    now = hooks.run(*one.c, one.threads);
    drop_fields(now);
    if (!now.completed) return false;
    if (!one.result.completed) {
      one.result = now;
    } else if (const std::string what = difference(one.result, now); !what.empty()) {
      outcome.departs.push_back(fmt::format("{}: {}", name_of(one), what));
    }
    return true;
  };

  std::vector<BenchCase*> open;
  CaseResult now;
  for (BenchCase& one : bench.cases) {
    if (!needs_more(one)) continue;
    if (stop || !run(one, now)) return outcome;
    if (one.timed()) open.push_back(&one);
  }
  while (!open.empty() && outcome.departs.empty()) {
    ++round;
    for (BenchCase* const one : open) {
      if (stop || !run(*one, now)) return outcome;
      one->samples.push_back({now, round, session, now.seconds});
      ++outcome.runs;
    }
    std::erase_if(open, [&](const BenchCase* one) { return !needs_more(*one); });
    if (hooks.after_round) hooks.after_round(round, open.size());
  }
  for (const BenchCase& one : bench.cases) {
    if (one.timed()) continue;
    outcome.failed.push_back(
        fmt::format("{}: {}", name_of(one), one.result.failure.empty() ? one.result.blow_up : one.result.failure));
  }
  return outcome;
}

}  // namespace acstudy
