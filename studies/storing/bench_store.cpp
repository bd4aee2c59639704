#include "studies/storing/bench_store.hpp"

#include <fmt/format.h>

#include <map>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <vector>

#include "studies/storing/files.hpp"
#include "studies/storing/h5_columns.hpp"
#include "studies/storing/json_form.hpp"
#include "studies/storing/keys.hpp"
#include "studies/storing/seal.hpp"

namespace acstudy {

namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

constexpr const char* bench_format = "acstudy-bench-1";

/// Visits what a bench keeps of the result of a case: what is the same in every run, but no fields.
template <class Result, class Visit>
void for_each_kept(Result& result, Visit&& visit) {
  CaseResult::stored(result, [&]<class T>(const Stored& as, T& value) {
    if constexpr (!is_field<T>) {
      if (!as.timed) visit(as, value);
    }
  });
}

template <class Record, class Visit>
void for_each_sample_column(Record& sample, Visit&& visit) {
  Sample::stored(sample, [&](const Stored& as, auto& value) { visit(as.name, value); });
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
  const Case& first = planned.series->cases.front();
  visit("study", planned.study->name);
  visit("title", planned.study->title);
  planned.series->stored([&](const Stored& as, const auto& value) { visit(as.flat().c_str(), value); });
  visit("scene", first.scene->text().name);
  visit("T", first.scene->T());
  visit("threads", static_cast<std::int64_t>(planned.threads));
}

json case_json(const BenchCase& one) {
  json out;
  const auto put = [&out](const Stored& as, const auto& value) { json_form::put(out, as, value); };
  one.c->stored(put);
  out["stages"] = one.c->integrator->stage_count();
  out["threads"] = one.threads;
  out["form"] = one.form;
  for_each_kept(one.result, put);
  out["failure"] = one.result.failure.empty() ? one.result.blow_up : one.result.failure;
  json samples;
  std::map<std::string, std::vector<double>> times;
  for (const Sample& sample : one.samples) {
    for_each_sample_column(sample, [&]<class T>(const char* name, const T& value) {
      samples[name].push_back(value);
      if constexpr (std::is_same_v<T, double>) times[name].push_back(value);
    });
  }
  for (const auto& [name, values] : times) {
    const Spread spread = spread_of(values);
    out[name] = {{"median", spread.median}, {"minimum", spread.minimum}, {"deviation", spread.deviation}};
  }
  if (!one.samples.empty()) out["samples"] = samples;
  return out;
}

std::string bench_json(const Bench& bench, const BenchOptions& options, const Provenance& provenance, bool complete) {
  json root = {{"format", bench_format},       {"complete", complete},
               {"runs", options.runs},         {"least_seconds", options.least_seconds},
               {"provenance", json::object()}, {"series", json::array()},
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
  return sealed(json_form::pretty(root)) + "\n";
}

void write_bench_case(hid_t parent, const std::string& name, const BenchCase& one) {
  const h5::Handle group = h5::create_group(parent, name);
  const auto write = [&](const Stored& as, const auto& value) { h5::write(group, as.column(), value); };
  h5::write_text(group, "key", bench_key(one));
  h5::write_number<std::int64_t>(group, "threads", one.threads);
  one.c->stored(write);
  for_each_kept(one.result, write);
  h5::write_columns(group, one.samples, Sample{},
                    [](const Sample& s, auto&& visit) { for_each_sample_column(s, visit); });
}

std::vector<char> bench_h5(const Bench& bench, const BenchOptions& options, const Provenance& provenance,
                           bool complete) {
  const h5::Handle root = h5::create_file_in_memory();
  h5::write_text(root, "format", bench_format);
  h5::write_number<std::int64_t>(root, "complete", complete ? 1 : 0);
  h5::write_number(root, "runs", options.runs);
  h5::write_number(root, "least_seconds", options.least_seconds);
  const h5::Handle origin = h5::create_group(root, "provenance");
  for (const auto& [name, value] : provenance) h5::write_text(origin, name, value);
  const auto places = places_in_files(bench);
  const h5::Handle all = h5::create_group(root, "series"), cases = h5::create_group(root, "cases");
  for (std::size_t i = 0; i < bench.series.size(); ++i) {
    const h5::Handle group = h5::create_group(all, fmt::format("{:03}", i));
    for_each_attribute(bench.series[i], [&](const char* name, const auto& value) { h5::write(group, name, value); });
    h5::write_column<std::int64_t>(group, "cases", cases_of(bench.series[i], places));
  }
  for (const auto& [i, place] : places) write_bench_case(cases, fmt::format("{:04}", place), bench.cases[i]);
  return sealed(h5::image(root));
}

void read_bench_case(hid_t group, BenchCase& one) {
  one.result.completed = true;
  for_each_kept(one.result, [&](const Stored& as, auto& value) { h5::read(group, as.column(), value); });
  one.samples.resize(h5::read_column<std::int64_t>(group, "round").size());
  h5::read_columns(group, one.samples, [](Sample& s, auto&& visit) { for_each_sample_column(s, visit); });
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
    const std::vector<char> bytes = bytes_of(file);
    if (seal_of(bytes) == Seal::broken) throw StoreError("it is not as it was written");
    const h5::Handle root = h5::open_image(bytes);
    if (h5::read_text(root, "format") != bench_format) {
      throw StoreError("its format is not " + std::string(bench_format));
    }
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
      read_bench_case(group, *found->second);
      ++taken;
    }
  } catch (const std::exception& error) {
    throw StoreError(
        fmt::format("{}: not a readable bench ({}); remove it, or use --fresh", file.string(), error.what()));
  }
  return taken;
}

}  // namespace acstudy
