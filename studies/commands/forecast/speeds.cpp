#include "studies/commands/forecast/speeds.hpp"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "studies/cases/checksum.hpp"
#include "studies/models/control_choice.hpp"
#include "studies/running/run_case.hpp"
#include "studies/storing/files.hpp"
#include "studies/storing/provenance.hpp"

namespace acstudy {

namespace {

namespace fs = std::filesystem;

/// $XDG_CACHE_HOME/acstudy or ~/.cache/acstudy; empty where neither is known.
fs::path cache_folder() {
  const auto variable = [](const char* name) {
    const char* const value = std::getenv(name);
    return fs::path(value != nullptr ? value : "");
  };
  if (const fs::path cache = variable("XDG_CACHE_HOME"); cache.is_absolute()) return cache / "acstudy";
  const fs::path home = variable("HOME");
  return home.is_absolute() ? home / ".cache" / "acstudy" : fs::path();
}

/// What speeds depend on besides what is run.
std::string machine_and_version() {
  utsname system{};
  uname(&system);
  std::string text = fmt::format("{}|{}", system.nodename, numerics_fingerprint());
  for (const auto& [name, value] : collect_provenance(1, "")) {
    if (name == "version" || name == "machine") text += "|" + value;
  }
  return text;
}

/// Larger cases are run with so many particles, to see how fast they are.
constexpr std::int64_t most_particles = 4096;

/// Equal for cases that take about the same time for the same work: within a factor of eight in N, and of four in the
/// number of neighbors.
std::string kind_of(const Plan& plan) {
  const Case& c = *plan.c;
  const SceneText& text = c.scene->text();
  const std::string scene =
      fmt::format("{}|{}|{}|{}|{}", text.c, text.b.value_or(""), text.solution(), text.flow.value_or(""), text.period);
  return fmt::format("{:016x}, {}, {}, {}, {}, N 8^{:.0f}, neighbors 4^{:.0f}", checksum(scene), plan.form->name,
                     scheme_label(c.scheme, c.scene->standing()) +
                         (c.scheme.control != nullptr ? fmt::format(" with {}", c.scheme.control->name) : ""),
                     c.nonlocal_source ? fmt::format("nonlocal source by rule {} times {}",
                                                     static_cast<int>(c.source_rule), c.source_refinement)
                                       : "local source",
                     fmt::format("{} by {}", c.integrator->name, static_cast<int>(c.step.bound)),
                     std::floor(std::log2(static_cast<double>(std::min(c.N, most_particles))) / 3.0),
                     plan.form->far ? 0.0 : std::floor(std::log2(std::max(1.0, c.delta / c.h)) / 2.0));
}

/// Work as `Case::estimated_work` has it; sums over far neighbors by boxes do not grow with the horizon.
double work_of(const Case& c, const Form& form) {
  if (!form.far) return c.estimated_work();
  return static_cast<double>(c.steps) * static_cast<double>(c.integrator->stage_count()) * static_cast<double>(c.N);
}

/// The case with so many steps of its length; equal ones where it has adaptive ones, for these cost the same.
Case shortened(const Case& c, std::int64_t steps) {
  Case one = c;
  if (c.step.adaptive()) {
    one.step = {};
    one.dt = c.scene->T() / static_cast<double>(c.steps);
  }
  SceneText text = c.scene->text();
  text.T = fmt::format("{:.17g}", one.dt * static_cast<double>(steps));
  one.scene = std::make_shared<const Scene>(text);
  one.steps = steps;
  one.limit = std::numeric_limits<double>::infinity();
  return one;
}

/// Of this thread: other programs on the machine take none of them.
double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Seconds of a unit of work of the case, from some of its steps.
std::optional<double> measured(const Plan& planned) {
  constexpr double enough = 0.005;
  Case c = *planned.c;
  if (c.N > most_particles) {
    const double larger = static_cast<double>(c.N) / most_particles;
    c.N = most_particles;
    c.h *= larger;
    c.dt *= larger;
    if (!planned.form->far) c.delta = std::min(c.delta * larger, 0.25 * c.scene->period());
  }
  const std::atomic<bool> stop = false;
  // What is done once, before the first step, is no part of the difference of two runs.
  double work_before = 0.0, before = 0.0;
  for (std::int64_t steps = std::min<std::int64_t>(4, c.steps);; steps = std::min(4 * steps, c.steps)) {
    const Case some = shortened(c, steps);
    const Plan one = plan(some);
    const double begin = processor_seconds();
    const CaseResult result = run_cases({&one, 1}, stop).front();
    const double seconds = processor_seconds() - begin;
    if (!result.failure.empty() || !result.blow_up.empty()) return std::nullopt;
    const double work = work_of(some, *planned.form);
    if ((before > 0.0 && seconds - before >= enough) || steps == c.steps) {
      return seconds > before ? (seconds - before) / (work - work_before) : seconds / work;
    }
    work_before = work;
    before = seconds;
  }
}

}  // namespace

Speeds::Speeds() {
  const fs::path folder = cache_folder();
  if (folder.empty()) return;
  file_ = folder / fmt::format("speeds-{:016x}.json", checksum(machine_and_version()));
  std::ifstream in(file_);
  const auto stored = nlohmann::json::parse(in, nullptr, false);
  if (!stored.is_object()) return;
  for (const auto& [kind, value] : stored.items()) {
    if (value.is_number() && value.get<double>() > 0.0) seconds_of_work_[kind] = value.get<double>();
  }
}

Speeds::~Speeds() {
  if (file_.empty() || !changed_) return;
  try {
    fs::create_directories(file_.parent_path());
    const std::string text = nlohmann::json(seconds_of_work_).dump(1) + "\n";
    replace_atomically(file_, text);
  } catch (const std::exception&) {
    // They are measured again next time.
  }
}

std::optional<double> Speeds::seconds(const Plan& plan) {
  const Case& c = *plan.c;
  if (c.scheme.program != nullptr) return std::nullopt;
  if (c.steps == 0) return 0.0;
  const std::string kind = kind_of(plan);
  auto known = seconds_of_work_.find(kind);
  if (known == seconds_of_work_.end()) {
    const auto found = measured(plan);
    if (!found) return std::nullopt;
    known = seconds_of_work_.emplace(kind, *found).first;
    changed_ = true;
  }
  return known->second * work_of(c, *plan.form);
}

}  // namespace acstudy
