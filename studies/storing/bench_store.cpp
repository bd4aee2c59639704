#include "studies/storing/bench_store.hpp"

#include <fmt/format.h>

#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "studies/storing/files.hpp"
#include "studies/storing/h5.hpp"
#include "studies/storing/json_form.hpp"
#include "studies/storing/keys.hpp"

namespace acstudy {

namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

constexpr const char* format = "acstudy-bench-1";

/// Visits the times of a sample with the names of their columns.
template <class S, class Visit>
void for_each_time(S& sample, Visit&& visit) {
  visit("seconds", sample.seconds);
  visit("positions_seconds", sample.positions_seconds);
  visit("weights_seconds", sample.weights_seconds);
  visit("pairs_seconds", sample.pairs_seconds);
  visit("source_seconds", sample.source_seconds);
}

/// Visits the work of a case, which is the same in every run.
template <class Result, class Visit>
void for_each_count(Result& result, Visit&& visit) {
  visit("pairs", result.work.pairs);
  visit("weight_builds", result.work.weight_builds);
  visit("quadrature_points", result.quadrature_points);
  visit("velocity_evaluations", result.work.velocity_evaluations);
  visit("flow_evaluations", result.flow_evaluations);
}

/// The columns of samples by name.
struct Columns {
  std::vector<std::int64_t> round, session;
  std::map<std::string, std::vector<double>> times;
};

Columns columns_of(const std::vector<Sample>& samples) {
  Columns columns;
  const Sample nothing;
  for_each_time(nothing, [&](const char* name, double) { columns.times[name]; });
  for (const Sample& sample : samples) {
    columns.round.push_back(sample.round);
    columns.session.push_back(sample.session);
    for_each_time(sample, [&](const char* name, double value) { columns.times[name].push_back(value); });
  }
  return columns;
}

/// Where the case that is number i of the bench stands in the files; those that have not run do not.
std::unordered_map<std::size_t, std::size_t> places_in_files(const Bench& bench) {
  std::unordered_map<std::size_t, std::size_t> places;
  for (std::size_t i = 0; i < bench.cases.size(); ++i) {
    if (bench.cases[i].result.completed) places.emplace(i, places.size());
  }
  return places;
}

std::vector<std::int64_t> cases_of(const BenchSeries& series,
                                   const std::unordered_map<std::size_t, std::size_t>& places) {
  std::vector<std::int64_t> cases;
  for (const std::size_t i : series.cases) {
    if (const auto found = places.find(i); found != places.end()) {
      cases.push_back(static_cast<std::int64_t>(found->second));
    }
  }
  return cases;
}

/// Visits what a series is, texts and numbers, with their names.
template <class Visit>
void for_each_attribute(const BenchSeries& planned, Visit&& visit) {
  const Series& series = *planned.series;
  const Case& first = series.cases.front();
  visit("study", planned.study->name);
  visit("title", planned.study->title);
  visit("model", static_cast<std::int64_t>(series.scheme.model));
  visit("divergence", std::string(series.scheme.nonlocal_divergence ? "nonlocal" : "local"));
  visit("kernel", series.scheme.kernel.name);
  if (series.scheme.kernel.name == "power") visit("alpha", series.scheme.kernel.alpha);
  if (series.scheme.model == 2) visit("mu", first.mu);
  visit("path", series.path);
  visit("delta", series.delta_text);
  visit("source", std::string(series.nonlocal_source ? "nonlocal" : "local"));
  visit("integrator", std::string(first.integrator->name));
  visit("step", first.step.label());
  visit("stepping", series.stepping);
  visit("motion", std::string(first.scene->standing() ? "standing" : "moving"));
  visit("scene", first.scene->text().name);
  visit("T", first.scene->T());
  visit("theory_order", series.theory.order);
  visit("threads", static_cast<std::int64_t>(planned.threads));
}

json case_json(const BenchCase& one) {
  json out = {{"N", one.c->N},
              {"h", one.c->h},
              {"delta", one.c->delta},
              {"dt", one.result.dt},
              {"steps", one.result.steps},
              {"stages", one.c->integrator->stage_count()},
              {"threads", one.threads},
              {"form", one.form},
              {"error_linf", one.result.error_linf},
              {"failure", one.result.failure.empty() ? one.result.blow_up : one.result.failure}};
  for_each_count(one.result, [&](const char* name, std::int64_t count) { out["work"][name] = count; });
  if (one.samples.empty()) return out;
  const Columns columns = columns_of(one.samples);
  for (const auto& [name, values] : columns.times) {
    const Spread spread = spread_of(values);
    out[name] = {{"median", spread.median}, {"minimum", spread.minimum}, {"deviation", spread.deviation}};
  }
  out["samples"] = {{"round", columns.round}, {"session", columns.session}};
  for (const auto& [name, values] : columns.times) out["samples"][name] = values;
  return out;
}

std::string bench_json(const Bench& bench, const BenchOptions& options, const Provenance& provenance, bool complete) {
  json root = {{"format", format},
               {"complete", complete},
               {"runs", options.runs},
               {"least_seconds", options.least_seconds},
               {"provenance", json::object()},
               {"series", json::array()},
               {"cases", json::array()}};
  for (const auto& [name, value] : provenance) root["provenance"][name] = value;
  const auto places = places_in_files(bench);
  for (const BenchSeries& series : bench.series) {
    json& out = root["series"].emplace_back();
    for_each_attribute(series, [&](const char* name, const auto& value) { out[name] = value; });
    out["cases"] = cases_of(series, places);
  }
  for (const BenchCase& one : bench.cases) {
    if (one.result.completed) root["cases"].push_back(case_json(one));
  }
  return json_form::pretty(root) + "\n";
}

void write_case(hid_t parent, const std::string& name, const BenchCase& one) {
  const h5::Handle group = h5::create_group(parent, name);
  h5::write_text(group, "key", bench_key(one));
  h5::write_text(group, "failure", one.result.failure);
  h5::write_text(group, "blow_up", one.result.blow_up);
  h5::write_number(group, "N", one.c->N);
  h5::write_number(group, "h", one.c->h);
  h5::write_number(group, "delta", one.c->delta);
  h5::write_number(group, "dt", one.result.dt);
  h5::write_number(group, "error_linf", one.result.error_linf);
  h5::write_number(group, "steps", one.result.steps);
  h5::write_number<std::int64_t>(group, "threads", one.threads);
  for_each_count(one.result, [&](const char* count, std::int64_t value) {
    h5::write_number(group, "work_" + std::string(count), value);
  });
  const Columns columns = columns_of(one.samples);
  h5::write_column<std::int64_t>(group, "round", columns.round);
  h5::write_column<std::int64_t>(group, "session", columns.session);
  for (const auto& [column, values] : columns.times) h5::write_column<double>(group, column, values);
}

std::vector<char> bench_h5(const Bench& bench, const BenchOptions& options, const Provenance& provenance,
                           bool complete) {
  const h5::Handle root = h5::create_file_in_memory("bench.h5");
  h5::write_text(root, "format", format);
  h5::write_number<std::int64_t>(root, "complete", complete ? 1 : 0);
  h5::write_number(root, "runs", options.runs);
  h5::write_number(root, "least_seconds", options.least_seconds);
  const h5::Handle origin = h5::create_group(root, "provenance");
  for (const auto& [name, value] : provenance) h5::write_text(origin, name, value);
  const auto places = places_in_files(bench);
  const h5::Handle all = h5::create_group(root, "series"), cases = h5::create_group(root, "cases");
  for (std::size_t i = 0; i < bench.series.size(); ++i) {
    const h5::Handle group = h5::create_group(all, fmt::format("{:03}", i));
    for_each_attribute(bench.series[i], [&]<class T>(const char* name, const T& value) {
      if constexpr (std::is_same_v<T, std::string>) {
        h5::write_text(group, name, value);
      } else {
        h5::write_number(group, name, value);
      }
    });
    h5::write_column<std::int64_t>(group, "cases", cases_of(bench.series[i], places));
  }
  for (const auto& [i, place] : places) write_case(cases, fmt::format("{:04}", place), bench.cases[i]);
  return h5::image(root);
}

std::vector<Sample> read_samples(hid_t group) {
  const auto round = h5::read_column<std::int64_t>(group, "round"),
             session = h5::read_column<std::int64_t>(group, "session");
  std::vector<Sample> samples(round.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].round = round[i];
    samples[i].session = session.at(i);
  }
  const Sample nothing;
  for_each_time(nothing, [&](const char* name, double) {
    const auto column = h5::read_column<double>(group, name);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      for_each_time(samples[i], [&](const std::string& time, double& value) {
        if (time == name) value = column.at(i);
      });
    }
  });
  return samples;
}

void read_case(hid_t group, BenchCase& one) {
  one.result.completed = true;
  one.result.failure = h5::read_text(group, "failure");
  one.result.blow_up = h5::read_text(group, "blow_up");
  one.result.dt = h5::read_number(group, "dt");
  one.result.error_linf = h5::read_number(group, "error_linf");
  one.result.steps = static_cast<std::int64_t>(h5::read_number(group, "steps"));
  for_each_count(one.result, [&](const char* name, std::int64_t& value) {
    value = static_cast<std::int64_t>(h5::read_number(group, "work_" + std::string(name)));
  });
  one.samples = read_samples(group);
}

}  // namespace

std::string bench_key(const BenchCase& one) { return storage_key(*one.c) + fmt::format("|threads={}", one.threads); }

void write_bench(const fs::path& out, const Bench& bench, const BenchOptions& options, const Provenance& provenance,
                 bool complete) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  replace_atomically(out / "bench.h5", bench_h5(bench, options, provenance, complete));
  replace_atomically(out / "bench.json", bench_json(bench, options, provenance, complete));
}

std::size_t take_up_bench(const fs::path& out, Bench& bench) {
  const fs::path file = out / "bench.h5";
  if (!fs::exists(file)) return 0;
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  std::size_t taken = 0;
  try {
    const h5::Handle root(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "open it");
    if (h5::read_text(root, "format") != format) throw StoreError("its format is not " + std::string(format));
    const h5::Handle origin = h5::open_group(root, "provenance");
    for (const auto& [name, value] : collect_provenance(0, "")) {
      if ((name == "machine" || name == "system") && h5::read_text(origin, name) != value) return 0;
    }
    std::unordered_map<std::string, BenchCase*> wanted;
    for (BenchCase& one : bench.cases) wanted.emplace(bench_key(one), &one);
    const h5::Handle cases = h5::open_group(root, "cases");
    for (const std::string& name : h5::group_names(cases)) {
      const h5::Handle group = h5::open_group(cases, name);
      const auto found = wanted.find(h5::read_text(group, "key"));
      if (found == wanted.end()) continue;
      read_case(group, *found->second);
      ++taken;
    }
  } catch (const std::exception& error) {
    throw StoreError(
        fmt::format("{}: not a readable bench ({}); remove it, or use --fresh", file.string(), error.what()));
  }
  return taken;
}

}  // namespace acstudy
