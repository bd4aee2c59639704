#include "studies/store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "studies/h5.hpp"

namespace acstudy {

namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

constexpr const char* format = "acstudy-1";

/// The scalar results of a case, by the name of their column in HDF5.
template <class T>
using Columns = std::vector<std::pair<const char*, std::function<T&(CaseResult&)>>>;

const Columns<double>& real_columns() {
  static const Columns<double> columns = {
      {"error_linf", [](CaseResult& r) -> double& { return r.error_linf; }},
      {"error_l1", [](CaseResult& r) -> double& { return r.error_l1; }},
      {"error_l2", [](CaseResult& r) -> double& { return r.error_l2; }},
      {"seconds", [](CaseResult& r) -> double& { return r.seconds; }},
      {"seconds_low", [](CaseResult& r) -> double& { return r.seconds_low; }},
      {"seconds_high", [](CaseResult& r) -> double& { return r.seconds_high; }},
      {"source_seconds", [](CaseResult& r) -> double& { return r.source_seconds; }},
  };
  return columns;
}

const Columns<std::int64_t>& count_columns() {
  static const Columns<std::int64_t> columns = {
      {"repeats", [](CaseResult& r) -> std::int64_t& { return r.repeats; }},
      {"work_pairs", [](CaseResult& r) -> std::int64_t& { return r.work.pairs; }},
      {"work_weight_builds", [](CaseResult& r) -> std::int64_t& { return r.work.weight_builds; }},
      {"work_quadrature_points", [](CaseResult& r) -> std::int64_t& { return r.quadrature_points; }},
      {"work_velocity_evaluations", [](CaseResult& r) -> std::int64_t& { return r.work.velocity_evaluations; }},
      {"work_flow_evaluations", [](CaseResult& r) -> std::int64_t& { return r.flow_evaluations; }},
  };
  return columns;
}

/// The cases of a series that have a result.
std::vector<std::size_t> completed(const SeriesResult& series) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < series.results.size(); ++i) {
    if (series.results[i].completed) indices.push_back(i);
  }
  return indices;
}

void write_series(hid_t parent, const std::string& group_name, const Study& study, const SeriesResult& result) {
  const Series& series = *result.series;
  const h5::Handle group = h5::create_group(parent, group_name);
  h5::write_number<std::int64_t>(group, "model", series.scheme.model);
  h5::write_text(group, "divergence", series.scheme.nonlocal_divergence ? "nonlocal" : "local");
  h5::write_text(group, "kernel", series.scheme.kernel.name);
  if (series.scheme.kernel.name == "power") h5::write_number(group, "alpha", series.scheme.kernel.alpha);
  if (series.scheme.model == 2) h5::write_number(group, "mu", series.cases.front().mu);
  h5::write_text(group, "path", series.path);
  h5::write_text(group, "delta_text", series.delta_text);
  h5::write_text(group, "source", series.nonlocal_source ? "nonlocal" : "local");
  h5::write_text(group, "integrator", std::string(study.integrator->name));
  h5::write_text(group, "step_text", study.step_text);
  h5::write_text(group, "motion", study.scene->standing() ? "standing" : "moving");
  h5::write_text(group, "theory_variable", series.theory.variable);
  h5::write_number(group, "theory_order", series.theory.order);
  h5::write_text(group, "theory_statement", series.theory.statement);
  h5::write_number(group, "observed_order", result.judgement.order);
  h5::write_number(group, "observed_low", result.judgement.low);
  h5::write_number(group, "observed_high", result.judgement.high);
  h5::write_number(group, "extrapolated_order", result.judgement.extrapolated);
  h5::write_text(group, "verdict", std::string(name_of(result.judgement.verdict)));
  h5::write_text(group, "expected", std::string(name_of(series.expected)));
  h5::write_number<std::int64_t>(group, "as_expected", result.as_expected() ? 1 : 0);
  h5::write_text(group, "reason", result.judgement.reason);
  h5::write_number<std::int64_t>(group, "cases_planned", std::ssize(series.cases));
  h5::write_column<double>(group, "pairwise", result.judgement.pairwise);

  const auto indices = completed(result);
  const auto column = [&]<class T>(const char* name, const std::function<T(std::size_t)>& value) {
    std::vector<T> values;
    for (const std::size_t i : indices) values.push_back(value(i));
    h5::write_column<T>(group, name, values);
  };
  using Count = std::function<std::int64_t(std::size_t)>;
  using Real = std::function<double(std::size_t)>;
  column("N", Count([&](std::size_t i) { return series.cases[i].N; }));
  column("steps", Count([&](std::size_t i) { return series.cases[i].steps; }));
  column("h", Real([&](std::size_t i) { return series.cases[i].h; }));
  column("delta", Real([&](std::size_t i) { return series.cases[i].delta; }));
  column("dt", Real([&](std::size_t i) { return series.cases[i].dt; }));
  column("variable", Real([&](std::size_t i) { return series.variable(series.cases[i].h, series.cases[i].delta); }));
  for (const auto& [name, member] : real_columns()) {
    column(name, Real([&](std::size_t i) { return member(const_cast<CaseResult&>(result.results[i])); }));
  }
  for (const auto& [name, member] : count_columns()) {
    column(name, Count([&](std::size_t i) { return member(const_cast<CaseResult&>(result.results[i])); }));
  }

  const h5::Handle cases = h5::create_group(group, "cases");
  for (const std::size_t i : indices) {
    const CaseResult& r = result.results[i];
    const h5::Handle one = h5::create_group(cases, std::to_string(series.cases[i].N));
    h5::write_text(one, "key", storage_key(series.cases[i]));
    h5::write_text(one, "failure", r.failure);
    h5::write_column<double>(one, "x", r.x);
    h5::write_column<double>(one, "u", r.u);
    h5::write_column<double>(one, "u_exact", r.u_exact);
  }
}

void write_h5(const fs::path& file, const Study& study, const std::vector<SeriesResult>& all,
              const Provenance& provenance) {
  const h5::Handle root(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose,
                        "create " + file.string());
  h5::write_text(root, "format", format);
  h5::write_text(root, "study", study.name);
  h5::write_text(root, "title", study.title);
  h5::write_text(root, "study_text", study.text);
  const h5::Handle origin = h5::create_group(root, "provenance");
  for (const auto& [name, value] : provenance) h5::write_text(origin, name, value);
  const h5::Handle scene = h5::create_group(root, "scene");
  const SceneText& text = study.scene->text();
  h5::write_text(scene, "name", text.name);
  h5::write_number(scene, "period", study.scene->period());
  h5::write_number(scene, "T", study.scene->T());
  h5::write_text(scene, "c", text.c);
  h5::write_text(scene, "u", text.u);
  if (text.b) h5::write_text(scene, "b", *text.b);
  if (text.flow) h5::write_text(scene, "flow", *text.flow);
  const h5::Handle series = h5::create_group(root, "series");
  for (std::size_t i = 0; i < all.size(); ++i) write_series(series, fmt::format("{:03}", i), study, all[i]);
  h5::check(H5Fflush(root, H5F_SCOPE_GLOBAL), "flush " + file.string());
}

json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json to_json(const Study& study, const SeriesResult& result) {
  const Series& series = *result.series;
  const Judgement& judgement = result.judgement;
  json out;
  out["model"] = series.scheme.model;
  out["divergence"] = series.scheme.nonlocal_divergence ? "nonlocal" : "local";
  out["kernel"] = series.scheme.kernel.name;
  if (series.scheme.kernel.name == "power") out["alpha"] = series.scheme.kernel.alpha;
  if (series.scheme.model == 2) out["mu"] = series.cases.front().mu;
  out["path"] = series.path;
  out["delta"] = series.delta_text;
  out["source"] = series.nonlocal_source ? "nonlocal" : "local";
  out["integrator"] = study.integrator->name;
  out["step"] = study.step_text;
  out["motion"] = study.scene->standing() ? "standing" : "moving";
  out["theory"] = {
      {"variable", series.theory.variable}, {"order", series.theory.order}, {"statement", series.theory.statement}};
  json pairwise = json::array();
  for (const double order : judgement.pairwise) pairwise.push_back(number(order));
  out["observed"] = {{"order", number(judgement.order)},
                     {"low", number(judgement.low)},
                     {"high", number(judgement.high)},
                     {"extrapolated", number(judgement.extrapolated)},
                     {"pairwise", pairwise}};
  out["verdict"] = name_of(judgement.verdict);
  out["expected"] = name_of(series.expected);
  out["as_expected"] = result.as_expected();
  out["reason"] = judgement.reason;
  out["cases_planned"] = series.cases.size();
  out["cases"] = json::array();
  for (const std::size_t i : completed(result)) {
    const Case& c = series.cases[i];
    const CaseResult& r = result.results[i];
    json one = {{"N", c.N},
                {"h", c.h},
                {"delta", c.delta},
                {"dt", c.dt},
                {"steps", c.steps},
                {"error_linf", number(r.error_linf)},
                {"error_l1", number(r.error_l1)},
                {"error_l2", number(r.error_l2)},
                {"seconds", r.seconds},
                {"seconds_low", r.seconds_low},
                {"seconds_high", r.seconds_high},
                {"repeats", r.repeats},
                {"source_seconds", r.source_seconds},
                {"work",
                 {{"pairs", r.work.pairs},
                  {"weight_builds", r.work.weight_builds},
                  {"quadrature_points", r.quadrature_points},
                  {"velocity_evaluations", r.work.velocity_evaluations},
                  {"flow_evaluations", r.flow_evaluations}}}};
    if (!r.failure.empty()) one["failure"] = r.failure;
    out["cases"].push_back(one);
  }
  return out;
}

/// JSON text with every real number at 17 significant digits; the library writes the fewest that read back the same.
std::string pretty(const json& value, int depth = 0) {
  const std::string inner(static_cast<std::size_t>(depth) * 2 + 2, ' '),
      outer(static_cast<std::size_t>(depth) * 2, ' ');
  const bool leaves = std::none_of(value.begin(), value.end(), [](const json& item) { return item.is_structured(); });
  const std::string separator = leaves ? ", " : ",\n" + inner, open = leaves ? " " : "\n" + inner,
                    close = leaves ? " " : "\n" + outer;
  if (value.is_number_float()) return fmt::format("{:.17g}", value.get<double>());
  if (!value.is_structured() || value.empty()) return value.dump();
  std::string text;
  for (const auto& [key, item] : value.items()) {
    text += text.empty() ? "" : separator;
    if (value.is_object()) text += json(key).dump() + ": ";
    text += pretty(item, depth + 1);
  }
  return value.is_object() ? "{" + open + text + close + "}" : "[" + open + text + close + "]";
}

void write_json(const fs::path& file, const Study& study, const std::vector<SeriesResult>& all,
                const Provenance& provenance) {
  json root = {{"study", study.name}, {"title", study.title}};
  root["provenance"] = json::object();
  for (const auto& [name, value] : provenance) root["provenance"][name] = value;
  root["series"] = json::array();
  for (const SeriesResult& series : all) root["series"].push_back(to_json(study, series));
  std::ofstream out(file, std::ios::binary);
  out << pretty(root) << '\n';
  out.close();
  if (!out) throw StoreError(fmt::format("{}: cannot write: {}", file.string(), std::strerror(errno)));
}

/// Runs `write` on a temporary file beside `file`, then puts it in place in one step.
template <class Write>
void replace_atomically(const fs::path& file, Write&& write) {
  const fs::path temporary = file.string() + fmt::format(".{}.partial", getpid());
  try {
    write(temporary);
    const int descriptor = open(temporary.c_str(), O_RDONLY);
    const bool safe = descriptor >= 0 && fsync(descriptor) == 0;
    if (descriptor >= 0) close(descriptor);
    if (!safe) throw StoreError(fmt::format("{}: cannot write to disk: {}", temporary.string(), std::strerror(errno)));
    fs::rename(temporary, file);
  } catch (const fs::filesystem_error& error) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw StoreError(fmt::format("{}: {}", file.string(), error.code().message()));
  } catch (...) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw;
  }
}

}  // namespace

Judgement judge_series(const Series& series, const std::vector<CaseResult>& results) {
  std::vector<Level> levels;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Case& c = series.cases[i];
    if (results[i].completed) levels.push_back({series.variable(c.h, c.delta), results[i].error_linf});
  }
  Judgement judgement = judge(levels, series.theory.order);
  for (const CaseResult& result : results) {
    if (!result.failure.empty()) judgement.reason += ": " + result.failure;
  }
  return judgement;
}

std::string storage_key(const Case& c) { return c.key() + "|numerics=" + numerics_fingerprint(); }

StoredCases load_cases(const fs::path& file) {
  StoredCases stored;
  if (!fs::exists(file)) return stored;
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  try {
    const h5::Handle root(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "open it");
    if (h5::read_text(root, "format") != format) throw StoreError("its format is not " + std::string(format));
    const h5::Handle origin = h5::open_group(root, "provenance");
    for (const auto& [name, value] : collect_provenance(0, ""))
      stored.provenance.emplace_back(name, h5::read_text(origin, name));
    const h5::Handle all = h5::open_group(root, "series");
    for (const std::string& name : h5::group_names(all)) {
      const h5::Handle group = h5::open_group(all, name), cases = h5::open_group(group, "cases");
      const auto N = h5::read_column<std::int64_t>(group, "N");
      std::vector<CaseResult> results(N.size());
      for (const auto& [column, member] : real_columns()) {
        const auto values = h5::read_column<double>(group, column);
        for (std::size_t i = 0; i < results.size(); ++i) member(results[i]) = values.at(i);
      }
      for (const auto& [column, member] : count_columns()) {
        const auto values = h5::read_column<std::int64_t>(group, column);
        for (std::size_t i = 0; i < results.size(); ++i) member(results[i]) = values.at(i);
      }
      for (std::size_t i = 0; i < results.size(); ++i) {
        const h5::Handle one = h5::open_group(cases, std::to_string(N[i]));
        CaseResult& result = results[i];
        result.completed = true;
        result.failure = h5::read_text(one, "failure");
        result.x = h5::read_column<double>(one, "x");
        result.u = h5::read_column<double>(one, "u");
        result.u_exact = h5::read_column<double>(one, "u_exact");
        stored.cases[h5::read_text(one, "key")] = std::move(result);
      }
    }
  } catch (const std::exception& error) {
    throw StoreError(
        fmt::format("{}: not a readable result file ({}); remove it, or use --fresh", file.string(), error.what()));
  }
  return stored;
}

void write_results(const fs::path& out, const Study& study, const std::vector<SeriesResult>& series,
                   const Provenance& provenance) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  replace_atomically(out / (study.name + ".h5"),
                     [&](const fs::path& file) { write_h5(file, study, series, provenance); });
  replace_atomically(out / (study.name + ".json"),
                     [&](const fs::path& file) { write_json(file, study, series, provenance); });
}

}  // namespace acstudy
