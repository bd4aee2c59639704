#include "studies/commands/forecast/forecast.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <utility>

#include "studies/commands/bytes.hpp"
#include "studies/reading/level_place.hpp"

namespace acstudy {

namespace {

/// Results are kept to the end of their study, and are there a second time while they are written.
double kept_bytes(const Series& series) {
  double bytes = 0.0;
  for (const Case& c : series.cases) bytes += 2.0 * c.result_bytes();
  return bytes;
}

/// The largest case of a series.
const Case& largest(const Series& series) {
  return *std::max_element(series.cases.begin(), series.cases.end(),
                           [](const Case& a, const Case& b) { return a.working_bytes() < b.working_bytes(); });
}

}  // namespace

double SeriesForecast::seconds() const {
  double sum = 0.0;
  for (const CaseForecast& one : cases) sum += one.seconds.value_or(0.0);
  return sum;
}

double SeriesForecast::bytes() const { return kept_bytes(*series) + largest(*series).working_bytes(); }

double StudyForecast::seconds() const {
  double sum = 0.0;
  for (const SeriesForecast& one : series) sum += one.seconds();
  return sum;
}

double StudyForecast::bytes() const {
  double kept = 0.0, working = 0.0;
  for (const SeriesForecast& one : series) {
    kept += kept_bytes(*one.series);
    working = std::max(working, largest(*one.series).working_bytes());
  }
  return kept + working;
}

StudyForecast forecast(const Study& study, Speeds& speeds) {
  std::vector<const Case*> cases;
  for (const Series& series : study.series) {
    for (const Case& c : series.cases) cases.push_back(&c);
  }
  std::vector<Plan> plans = plan(cases);
  // Local and nonlocal divergence share their sums over pairs.
  std::map<std::pair<std::string, std::string>, int> sharing;
  for (const Plan& one : plans) sharing[{one.particles, one.pairs}] += one.form->together ? 1 : 0;
  StudyForecast all{&study, {}};
  auto next = plans.begin();
  for (const Series& series : study.series) {
    SeriesForecast& of_series = all.series.emplace_back(SeriesForecast{&series, {}});
    for (const Case& c : series.cases) {
      const Plan& one = *next++;
      std::optional<double> seconds = speeds.seconds(one);
      if (seconds) *seconds /= std::clamp(sharing[{one.particles, one.pairs}], 1, 2);
      of_series.cases.push_back({one, seconds, c.working_bytes() + c.result_bytes()});
    }
  }
  return all;
}

double available_memory() {
  double bytes = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  // A container may have less than its machine; without a limit the file says "max", which is no number.
  rlimit own{};
  if (getrlimit(RLIMIT_AS, &own) == 0 && own.rlim_cur != RLIM_INFINITY) {
    bytes = std::min(bytes, static_cast<double>(own.rlim_cur));
  }
  double limit = 0.0;
  if (std::ifstream("/sys/fs/cgroup/memory.max") >> limit && limit > 0.0) bytes = std::min(bytes, limit);
  return bytes;
}

void require_memory(std::span<const Study> studies) {
  const double there = available_memory();
  for (const Study& study : studies) {
    double kept = 0.0;
    const Case* worst = nullptr;
    const Series* of = nullptr;
    for (const Series& series : study.series) {
      kept += kept_bytes(series);
      const Case& c = largest(series);
      if (worst != nullptr && c.working_bytes() <= worst->working_bytes()) continue;
      worst = &c;
      of = &series;
    }
    if (worst == nullptr || kept + worst->working_bytes() <= there) continue;
    place_of_level(study, *of, worst->N)
        .fail(fmt::format("N = {} takes about {} of memory, with the results of all cases {}, and there are {}; leave "
                          "out the finest levels, or split the study",
                          worst->N, bytes_text(worst->working_bytes() + worst->result_bytes()),
                          bytes_text(kept + worst->working_bytes()), bytes_text(there)));
  }
}

}  // namespace acstudy
