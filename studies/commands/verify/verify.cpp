#include "studies/commands/verify/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <mutex>
#include <string_view>
#include <unordered_map>

#include "studies/cases/checksum.hpp"
#include "studies/commands/run/parallel.hpp"
#include "studies/commands/stop.hpp"
#include "studies/kinds/study_file.hpp"
#include "studies/reading/input_error.hpp"
#include "studies/running/run_case.hpp"
#include "studies/storing/case_checksum.hpp"
#include "studies/storing/origin.hpp"
#include "studies/storing/study_h5.hpp"

namespace acstudy {

namespace {

/// Largest difference of two lists of numbers, relative to the largest of the first.
double relative_difference(std::span<const double> stored, std::span<const double> now) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  if (stored.size() != now.size()) return infinite;
  double difference = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < stored.size(); ++i) {
    if (std::isnan(stored[i]) && std::isnan(now[i])) continue;
    if (std::isinf(stored[i]) && stored[i] == now[i]) continue;
    if (!std::isfinite(stored[i]) || !std::isfinite(now[i])) return infinite;
    largest = std::max(largest, std::abs(stored[i]));
    difference = std::max(difference, std::abs(stored[i] - now[i]));
  }
  return difference == 0.0 ? 0.0 : difference / std::max(largest, std::numeric_limits<double>::min());
}

/// Compares values by name, one after the other.
class Difference {
 public:
  explicit Difference(double tolerance) : tolerance_(tolerance) {}

  template <class T>
  void compare(const std::string& name, const T& stored, const T& now) {
    double by = 0.0;
    if constexpr (std::is_same_v<T, double>) {
      by = relative_difference({&stored, 1}, {&now, 1});
    } else if constexpr (std::is_same_v<T, PointArray>) {
      by = relative_difference(stored.coordinates, now.coordinates);
    } else if constexpr (std::is_same_v<T, std::vector<double>>) {
      by = relative_difference(stored, now);
    } else if (tolerance_ > 0.0) {
      return;  // counts and words follow from the numbers, which another machine rounds in another way
    }
    largest = std::max(largest, by);
    std::vector<std::string> bytes;
    for (const T* const one : {&stored, &now}) {
      std::string& all = bytes.emplace_back();
      with_bytes(*one, [&](std::span<const char> some) { all.append(some.begin(), some.end()); });
    }
    const bool same = tolerance_ > 0.0 ? by <= tolerance_ : bytes[0] == bytes[1];
    if (same || !what.empty()) return;
    what = name;
    if constexpr (std::is_arithmetic_v<T>) what = fmt::format("{} is {} and was stored as {}", name, now, stored);
  }

  std::string what;      ///< the first that differs
  double largest = 0.0;  ///< relative difference of numbers

 private:
  double tolerance_;
};

void compare(const CaseResult& stored, const CaseResult& now, bool against_reference, Difference& difference) {
  // The two are visited in step: what the first gives is kept until the second is there.
  std::vector<const void*> values;
  CaseResult::stored(stored, [&](const Stored&, const auto& value) { values.push_back(&value); });
  std::size_t i = 0;
  CaseResult::stored(now, [&]<class T>(const Stored& as, const T& value) {
    const T& before = *static_cast<const T*>(values[i++]);
    const std::string name = as.flat();
    const bool of_reference =
        against_reference && (name.starts_with("error_") || name == "u_exact" || name == "solution_linf");
    if (!as.timed && !of_reference) difference.compare(name, before, value);
  });
}

void compare(const Finding& stored, const Finding& now, Difference& difference) {
  const auto column = [](const Finding& finding, double Point::*value) {
    std::vector<double> values;
    for (const Point& point : finding.points) values.push_back(point.*value);
    return values;
  };
  difference.compare("value", column(stored, &Point::value), column(now, &Point::value));
  difference.compare("lower bound", column(stored, &Point::lower), column(now, &Point::lower));
  difference.compare("upper bound", column(stored, &Point::upper), column(now, &Point::upper));
  difference.compare("variable", column(stored, &Point::variable), column(now, &Point::variable));
  difference.compare("failure", stored.failure, now.failure);
}

/// What can be computed anew: how it is called, and how that is done.
struct Item {
  std::string name;
  std::function<Difference(double tolerance, const std::atomic<bool>& stop)> compare;
};

/// The cases that are stored, by their inputs, whatever sources computed them.
std::unordered_map<std::string, const CaseResult*> by_inputs(const StoredCases& stored) {
  std::unordered_map<std::string, const CaseResult*> found;
  for (const auto& [key, result] : stored.cases) found.emplace(key.substr(0, key.find("|numerics=")), &result);
  return found;
}

/// Gives the series their stored results, and lists what is stored.
std::vector<Item> items_of(Study& study, const StoredCases& stored, std::vector<SeriesResult>& results) {
  std::vector<Item> items;
  const auto found = by_inputs(stored);
  for (Series& series : study.series) {
    SeriesResult& of_series = results.emplace_back(SeriesResult{&series, {}});
    for (Case& c : series.cases) {
      of_series.results.emplace_back();
      auto one = found.find(c.key());
      if (one == found.end()) {
        Case readable = c;
        readable.readable = true;
        one = found.find(readable.key());
        if (one == found.end()) continue;
        c.readable = true;
      }
      const CaseResult& before = *one->second;
      of_series.results.back() = before;
      items.push_back({fmt::format("{}, N = {}", series.label(), c.N),
                       [&c, &before, reference = series.against_reference](double tolerance, const auto& stop) {
                         Difference difference(tolerance);
                         const CaseResult now = run_case(c, stop);
                         if (now.completed) compare(before, now, reference, difference);
                         return difference;
                       }});
    }
  }
  for (const auto& [number, finding] : stored.findings) {
    if (number >= study.measurements.size()) continue;
    const Measurement& measurement = study.measurements[number];
    items.push_back(
        {measurement.check.label(), [&measurement, &before = finding, &results](double tolerance, const auto&) {
           Difference difference(tolerance);
           compare(before, measurement.take(results), difference);
           return difference;
         }});
  }
  return items;
}

/// All that is used while items are computed: it may have to outlive the call.
struct Work {
  Study study;
  StoredCases stored;
  std::vector<SeriesResult> results;
  std::vector<Item> items;
  std::mutex mutex;
  std::size_t next = 0;
  Verified found;
  std::exception_ptr failure;
};

}  // namespace

Verified verify(const std::filesystem::path& file, const VerifyOptions& options, const std::atomic<bool>& stop) {
  const StudyOrigin origin = study_of_h5(file);
  const auto work = std::make_shared<Work>();
  work->study = parse_study(origin.text, origin.file);
  work->stored = load_cases(file, true);
  for (const std::string& what : work->stored.damaged) work->found.differ.push_back(what + ": not as it was written");
  std::vector<Item>& items = work->items = items_of(work->study, work->stored, work->results);
  if (items.empty()) {
    throw InputError(
        fmt::format("{}: nothing in it that this version would compute; verify it with the version that "
                    "its provenance names, or run the study again",
                    file.string()));
  }
  work->found.stored = items.size();
  if (options.sample && *options.sample < items.size()) {
    std::sort(items.begin(), items.end(),
              [](const Item& a, const Item& b) { return checksum(a.name) < checksum(b.name); });
    items.resize(*options.sample);
  }
  const auto compute = [work, options, &stop] {
    work->failure = in_parallel(std::min<std::size_t>(options.jobs, work->items.size()), [&] {
      std::unique_lock lock(work->mutex);
      if (work->next == work->items.size() || stop) return false;
      const Item& item = work->items[work->next++];
      lock.unlock();
      const Difference difference = item.compare(options.tolerance, stop);
      lock.lock();
      if (stop) return false;  // it may be that it was not computed to its end
      Verified& found = work->found;
      ++found.computed;
      found.largest = std::max(found.largest, difference.largest);
      if (!difference.what.empty()) found.differ.push_back(fmt::format("{}: {}", item.name, difference.what));
      return true;
    });
  };
  const bool ended = done_before_stop(stop, compute);
  const std::lock_guard lock(work->mutex);
  if (ended && work->failure) std::rethrow_exception(work->failure);
  Verified found = work->found;
  found.interrupted = stop;
  found.left_running = !ended;
  std::sort(found.differ.begin(), found.differ.end());
  return found;
}

}  // namespace acstudy
