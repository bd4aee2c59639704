#include "studies/storing/store.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <sstream>
#include <thread>

#include "build_info.hpp"
#include "studies/storing/checksum.hpp"
#include "studies/storing/h5.hpp"
#include "studies/storing/journal.hpp"
#include "studies/storing/result_json.hpp"
#include "studies/storing/stored_parts.hpp"

namespace acstudy {

namespace {

namespace fs = std::filesystem;

constexpr const char* format = "acstudy-1";

/// Visits the scalar results of a case with the names of their columns.
template <class Result, class Visit>
void for_each_column(Result& result, Visit&& visit) {
  visit("error_linf", result.error_linf);
  visit("solution_linf", result.solution_linf);
  visit("error_l1", result.error_l1);
  visit("error_l2", result.error_l2);
  visit("seconds", result.seconds);
  visit("seconds_low", result.seconds_low);
  visit("seconds_high", result.seconds_high);
  visit("positions_seconds", result.positions_seconds);
  visit("weights_seconds", result.weights_seconds);
  visit("pairs_seconds", result.pairs_seconds);
  visit("source_seconds", result.source_seconds);
  visit("repeats", result.repeats);
  visit("work_pairs", result.work.pairs);
  visit("work_weight_builds", result.work.weight_builds);
  visit("work_quadrature_points", result.quadrature_points);
  visit("work_velocity_evaluations", result.work.velocity_evaluations);
  visit("work_flow_evaluations", result.flow_evaluations);
  visit("steps", result.steps);
  visit("dt", result.dt);
  visit("dt_smallest", result.dt_smallest);
  visit("bound_largest", result.against_bound.largest);
  visit("bound_first_step", result.against_bound.first_step);
  visit("bound_first_time", result.against_bound.first_time);
  visit("bound_first_place", result.against_bound.first_place);
  visit("last_step", result.last.step);
  visit("last_time", result.last.time);
  visit("last_particle", result.last.particle);
  visit("last_place", result.last.place);
  visit("last_error_linf", result.last.error_linf);
  visit("last_error_l1", result.last.error_l1);
  visit("last_error_l2", result.last.error_l2);
}

/// Columns of a series by name, real numbers and counts.
struct Columns {
  std::map<std::string, std::vector<double>> real;
  std::map<std::string, std::vector<std::int64_t>> count;

  std::vector<double>& of(const std::string& name, double) { return real[name]; }
  std::vector<std::int64_t>& of(const std::string& name, std::int64_t) { return count[name]; }
};

void write_texts_and_fields(hid_t group, const std::string& key, const CaseResult& r, bool against_reference = false) {
  h5::write_text(group, "key", key);
  h5::write_text(group, "blow_up", r.blow_up);
  h5::write_text(group, "failure", r.failure);
  h5::write_column<double>(group, "x", r.x);
  h5::write_column<double>(group, "u", r.u);
  if (!against_reference) {
    h5::write_column<double>(group, "u_exact", r.u_exact);
  } else if (!r.u_exact.empty()) {
    h5::write_column<double>(group, "u_reference", r.u_exact);
  }
}

void read_texts_and_fields(hid_t group, CaseResult& r) {
  r.completed = true;
  r.blow_up = h5::read_text(group, "blow_up");
  r.failure = h5::read_text(group, "failure");
  r.x = h5::read_column<double>(group, "x");
  r.u = h5::read_column<double>(group, "u");
  // What a reference gives is found anew.
  if (H5Lexists(group, "u_exact", H5P_DEFAULT) > 0) r.u_exact = h5::read_column<double>(group, "u_exact");
}

/// A column for each of the results of these cases, and their fields.
void write_cases(hid_t group, const SeriesResult& result, const std::vector<std::size_t>& indices) {
  const Series& series = *result.series;
  Columns columns;
  const auto visit = [&series](const Case& c, const CaseResult& r, auto&& column) {
    column("N", c.N);
    column("h", c.h);
    column("delta", c.delta);
    column("variable", series.variable(c.h, c.delta));
    for_each_column(r, column);
  };
  // Without a completed case the columns are there all the same, and empty.
  visit(series.cases.front(), CaseResult{}, [&](const char* name, auto value) { columns.of(name, value); });
  for (const std::size_t i : indices) {
    visit(series.cases[i], result.results[i],
          [&](const char* name, auto value) { columns.of(name, value).push_back(value); });
  }
  for (const auto& [name, values] : columns.real) h5::write_column<double>(group, name, values);
  for (const auto& [name, values] : columns.count) h5::write_column<std::int64_t>(group, name, values);

  const h5::Handle cases = h5::create_group(group, "cases");
  for (const std::size_t i : indices) {
    const h5::Handle one = h5::create_group(cases, std::to_string(series.cases[i].N));
    write_texts_and_fields(one, storage_key(series.cases[i]), result.results[i], series.against_reference);
  }
}

void write_series(hid_t parent, const std::string& group_name, const SeriesResult& result) {
  const Series& series = *result.series;
  const h5::Handle group = h5::create_group(parent, group_name);
  h5::write_number<std::int64_t>(group, "model", series.scheme.model->number);
  h5::write_text(group, "divergence", series.scheme.nonlocal_divergence ? "nonlocal" : "local");
  h5::write_text(group, "kernel", series.scheme.kernel.name);
  if (series.scheme.kernel.name == "power") h5::write_number(group, "alpha", series.scheme.kernel.alpha);
  if (series.scheme.model->viscous) h5::write_number(group, "mu", series.cases.front().mu);
  h5::write_text(group, "path", series.path);
  h5::write_text(group, "delta_text", series.delta_text);
  h5::write_text(group, "source", series.nonlocal_source ? "nonlocal" : "local");
  h5::write_text(group, "integrator", std::string(series.cases.front().integrator->name));
  h5::write_text(group, "step_text", series.cases.front().step.label());
  h5::write_text(group, "start", series.cases.front().start.label());
  h5::write_text(group, "stepping", series.stepping);
  h5::write_text(group, "motion", series.cases.front().scene->standing() ? "standing" : "moving");
  h5::write_text(group, "theory_variable", series.theory.variable);
  h5::write_number(group, "theory_order", series.theory.order);
  h5::write_text(group, "theory_statement", series.theory.statement);
  for (const auto& [name, value] : named_estimates(result.judgement)) {
    h5::write_number(group, "observed_" + name, value);
  }
  h5::write_number(group, "extrapolated_order", result.judgement.extrapolated);
  h5::write_text(group, "verdict", std::string(name_of(result.judgement.verdict)));
  h5::write_text(group, "expected", std::string(name_of(series.expected)));
  h5::write_number<std::int64_t>(group, "as_expected", result.as_expected() ? 1 : 0);
  h5::write_text(group, "reason", result.judgement.reason);
  h5::write_number<std::int64_t>(group, "cases_planned", std::ssize(series.cases));
  h5::write_column<double>(group, "pairwise", result.judgement.pairwise);

  write_cases(group, result, result.completed_levels());
  if (result.reference() != nullptr) {
    write_cases(h5::create_group(group, "reference"), result, std::vector{series.levels()});
  }
}

/// Visits the columns of a point with their names.
template <class P, class Visit>
void for_each_point_column(P& point, Visit&& visit) {
  visit("N", point.N);
  visit("h", point.h);
  visit("delta", point.delta);
  visit("variable", point.variable);
  visit("value", point.value);
  visit("lower", point.lower);
  visit("upper", point.upper);
}

/// Visits the texts of a finding with their names.
template <class F, class Visit>
void for_each_text(F& finding, Visit&& visit) {
  visit("statement", finding.statement);
  visit("claim", finding.claim);
  visit("subject", finding.subject);
  visit("check", finding.check);
  visit("quantity", finding.quantity);
  visit("variable_name", finding.variable);
  visit("remark", finding.remark);
  visit("failure", finding.failure);
}

void write_surface(hid_t group, const SurfaceFit& fit) {
  const auto write = [&](const std::string& name, double value) { h5::write_number(group, "surface_" + name, value); };
  const auto write_powers = [&](const std::string& prefix, const TwoPowers& powers) {
    write(prefix + "A", powers.A);
    write(prefix + "B", powers.B);
    for (const auto& [name, order] : {std::pair{"p", powers.p}, std::pair{"q", powers.q}}) {
      write(prefix + name, order.value);
      write(prefix + name + "_low", order.low);
      write(prefix + name + "_high", order.high);
    }
    write(prefix + "rms", powers.rms);
    write(prefix + "bic", powers.bic);
  };
  write_powers("", fit);
  if (fit.sum) write_powers("sum_", *fit.sum);
  write("h_correction", fit.h_correction);
  write("delta_correction", fit.delta_correction);
  write("sharpness", fit.sharpness);
  write("bic_h", fit.bic_h);
  write("bic_delta", fit.bic_delta);
}

}  // namespace

void write_case(hid_t parent, const std::string& group_name, const std::string& key, const CaseResult& result) {
  const h5::Handle group = h5::create_group(parent, group_name);
  write_texts_and_fields(group, key, result);
  for_each_column(result, [&](const char* name, auto value) { h5::write_number(group, name, value); });
}

CaseResult read_case(hid_t group) {
  CaseResult result;
  read_texts_and_fields(group, result);
  for_each_column(result, [&]<class T>(const char* name, T& value) { value = h5::read_number<T>(group, name); });
  return result;
}

void write_finding(hid_t parent, const std::string& group_name, const Finding& finding) {
  const h5::Handle group = h5::create_group(parent, group_name);
  for_each_text(finding, [&](const char* name, const std::string& text) { h5::write_text(group, name, text); });
  h5::write_text(group, "test", std::string(name_of(finding.test)));
  h5::write_number(group, "theory_order", finding.theory_order);
  h5::write_number(group, "scale", finding.known.scale.value_or(not_estimated));
  h5::write_number(group, "floor", finding.known.floor.value_or(not_estimated));
  h5::write_text(group, "promised", std::string(name_of(finding.promised)));
  h5::write_text(group, "expected", std::string(name_of(finding.expected)));
  std::string also;
  for (const Verdict verdict : finding.also_expected) also += (also.empty() ? "" : " ") + std::string(name_of(verdict));
  h5::write_text(group, "also_expected", also);
  h5::write_text(group, "verdict", std::string(name_of(finding.judgement.verdict)));
  h5::write_text(group, "reason", finding.judgement.reason);
  h5::write_number<std::int64_t>(group, "as_expected", finding.as_expected() ? 1 : 0);
  h5::write_number<std::int64_t>(group, "alarm", finding.alarm() ? 1 : 0);
  h5::write_number(group, "observed_order", finding.judgement.order);
  h5::write_number(group, "observed_low", finding.judgement.low);
  h5::write_number(group, "observed_high", finding.judgement.high);
  h5::write_number(group, "extrapolated_order", finding.judgement.extrapolated);
  Columns columns;
  const Point nothing;
  for_each_point_column(nothing, [&](const char* name, auto value) { columns.of(name, value); });
  for (const Point& point : finding.points) {
    for_each_point_column(point, [&](const char* name, auto value) { columns.of(name, value).push_back(value); });
  }
  for (const auto& [name, values] : columns.real) h5::write_column<double>(group, name, values);
  for (const auto& [name, values] : columns.count) h5::write_column<std::int64_t>(group, name, values);
  std::string labels;
  if (std::any_of(finding.points.begin(), finding.points.end(), [](const Point& p) { return !p.label.empty(); })) {
    for (const Point& point : finding.points) labels += point.label + "\n";
  }
  h5::write_text(group, "labels", labels);
  if (const auto& fit = finding.surface) write_surface(group, *fit);
}

Finding read_finding(hid_t group) {
  Finding finding{};
  for_each_text(finding, [&](const char* name, std::string& text) { text = h5::read_text(group, name); });
  finding.test = test_from(h5::read_text(group, "test")).value();
  finding.theory_order = h5::read_number(group, "theory_order");
  const auto known = [&](const char* name) {
    const double value = h5::read_number(group, name);
    return std::isnan(value) ? std::nullopt : std::optional(value);
  };
  finding.known = {.scale = known("scale"), .floor = known("floor")};
  finding.promised = verdict_from(h5::read_text(group, "promised")).value();
  finding.expected = verdict_from(h5::read_text(group, "expected")).value();
  std::istringstream also(h5::read_text(group, "also_expected"));
  for (std::string name; also >> name;) finding.also_expected.push_back(verdict_from(name).value());
  Columns columns;
  finding.points.resize(h5::read_column<double>(group, "value").size());
  for (std::size_t i = 0; i < finding.points.size(); ++i) {
    for_each_point_column(finding.points[i], [&]<class T>(const char* name, T& value) {
      std::vector<T>& values = columns.of(name, T{});
      if (values.empty()) values = h5::read_column<T>(group, name);
      value = values.at(i);
    });
  }
  std::istringstream labels(h5::read_text(group, "labels"));
  for (Point& point : finding.points) std::getline(labels, point.label);
  judge(finding);
  return finding;
}

namespace {

/// The HDF5 file as bytes.
std::vector<char> h5_image(const StudyResult& result, const Provenance& provenance) {
  const Study& study = *result.study;
  const h5::Handle root = h5::create_file_in_memory(study.name + ".h5");
  h5::write_text(root, "format", format);
  h5::write_text(root, "study", study.name);
  h5::write_text(root, "title", study.title);
  h5::write_text(root, "kind", study.kind);
  h5::write_text(root, "study_text", study.text);
  h5::write_text(root, "study_file", absolute_path(study.file));
  const h5::Handle origin = h5::create_group(root, "provenance");
  for (const auto& [name, value] : provenance) h5::write_text(origin, name, value);
  if (study.scene) {
    const h5::Handle scene = h5::create_group(root, "scene");
    const SceneText& text = study.scene->text();
    h5::write_text(scene, "name", text.name);
    h5::write_number(scene, "period", study.scene->period());
    h5::write_number(scene, "T", study.scene->T());
    h5::write_text(scene, "c", text.c);
    if (study.scene->solved()) h5::write_text(scene, "u", text.u);
    if (text.u0) h5::write_text(scene, "u0", *text.u0);
    if (text.f) h5::write_text(scene, "f", *text.f);
    if (text.b) h5::write_text(scene, "b", *text.b);
    if (text.flow) h5::write_text(scene, "flow", *text.flow);
  }
  const h5::Handle series = h5::create_group(root, "series");
  for (std::size_t i = 0; i < result.series.size(); ++i) {
    write_series(series, fmt::format("{:03}", i), result.series[i]);
  }
  const h5::Handle findings = h5::create_group(root, "findings");
  h5::write_text(root, "findings_key", findings_key(study));
  for (std::size_t i = 0; i < result.findings.size(); ++i) {
    if (result.findings[i]) write_finding(findings, fmt::format("{:04}", i), *result.findings[i]);
  }
  return h5::image(root);
}

/// Another process holds a lock that keeps HDF5 from reading the file.
bool locked(const fs::path& file) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool is_locked = flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(descriptor);
  return is_locked;
}

/// Opens a file for reading. Waits some two seconds for one that is locked.
h5::Handle open_when_unlocked(const fs::path& file) {
  const auto try_it = [&] { return H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT); };
  hid_t id = try_it();
  for (int tries = 0; id < 0 && locked(file); ++tries) {
    if (tries == 8) {
      throw StoreLocked(fmt::format(
          "{}: locked: another program holds it open for writing; close it there, or name another folder with --out",
          file.string()));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(250));
    id = try_it();
  }
  if (id < 0) id = try_it();  // it may have been unlocked in between
  return {id, H5Fclose, "open it"};
}

/// What `write_cases` has written.
void read_cases(hid_t group, StoredCases& stored) {
  const h5::Handle cases = h5::open_group(group, "cases");
  const auto N = h5::read_column<std::int64_t>(group, "N");
  std::vector<CaseResult> results(N.size());
  Columns columns;
  for (std::size_t i = 0; i < results.size(); ++i) {
    for_each_column(results[i], [&]<class T>(const char* column, T& value) {
      // Files of older versions lack some. Their cases have other keys, so nothing is missed.
      if (H5Lexists(group, column, H5P_DEFAULT) <= 0) return;
      std::vector<T>& values = columns.of(column, T{});
      if (values.empty()) values = h5::read_column<T>(group, column);
      value = values.at(i);
    });
  }
  for (std::size_t i = 0; i < results.size(); ++i) {
    const h5::Handle one = h5::open_group(cases, std::to_string(N[i]));
    read_texts_and_fields(one, results[i]);
    stored.cases[h5::read_text(one, "key")] = std::move(results[i]);
  }
}

/// Adds the content of the HDF5 file.
void read_results(const fs::path& file, StoredCases& stored) {
  const h5::Handle root = open_when_unlocked(file);
  if (h5::read_text(root, "format") != format) throw StoreError("its format is not " + std::string(format));
  if (H5Aexists(root, "study_file") > 0) {
    stored.study_file = h5::read_text(root, "study_file");
    stored.study_text = h5::read_text(root, "study_text");
  }
  const h5::Handle origin = h5::open_group(root, "provenance");
  // Nothing that other sources have computed is used again, and they may have stored it in another way.
  if (h5::read_text(origin, "numerics") != build_info::numerics) return;
  for (const auto& [name, value] : collect_provenance(0, ""))
    stored.provenance.emplace_back(name, h5::read_text(origin, name));
  const h5::Handle all = h5::open_group(root, "series");
  for (const std::string& name : h5::group_names(all)) {
    const h5::Handle group = h5::open_group(all, name);
    read_cases(group, stored);
    if (H5Lexists(group, "reference", H5P_DEFAULT) > 0) read_cases(h5::open_group(group, "reference"), stored);
  }
  // Findings of other sources are not used again, so they need not be readable; older files have none.
  if (H5Lexists(root, "findings", H5P_DEFAULT) <= 0) return;
  stored.findings_key = h5::read_text(root, "findings_key");
  if (!of_these_measurements(stored.findings_key)) return;
  const h5::Handle findings = h5::open_group(root, "findings");
  for (const std::string& name : h5::group_names(findings)) {
    stored.findings.emplace(std::stoul(name), read_finding(h5::open_group(findings, name)));
  }
}

}  // namespace

void replace_atomically(const fs::path& file, std::span<const char> content) {
  const fs::path temporary = file.string() + fmt::format(".{}.partial", getpid());
  std::FILE* const stream = std::fopen(temporary.c_str(), "wb");
  bool good = stream != nullptr && std::fwrite(content.data(), 1, content.size(), stream) == content.size() &&
              std::fflush(stream) == 0 && fsync(fileno(stream)) == 0;
  int error = errno;
  if (stream != nullptr) std::fclose(stream);
  if (good) {
    good = std::rename(temporary.c_str(), file.c_str()) == 0;
    error = errno;
  }
  if (good) return;
  std::error_code ignored;
  fs::remove(temporary, ignored);
  throw StoreError(
      fmt::format("{}: cannot be written: {}; free space or name another place", file.string(), std::strerror(error)));
}

std::vector<std::pair<std::string, double>> named_estimates(const Judgement& j) {
  const auto number = [](std::size_t level) { return static_cast<double>(level + 1); };
  return {{"order", j.order},
          {"low", j.low},
          {"high", j.high},
          {"window_first", number(j.window.first)},
          {"window_last", number(j.window.last)},
          {"fitted", j.fitted.order},
          {"fitted_low", j.fitted.low},
          {"fitted_high", j.fitted.high},
          {"extrapolated_low", j.corrected.low},
          {"extrapolated_high", j.corrected.high},
          {"correction_D", j.corrected.D},
          {"correction_q", j.corrected.q},
          {"floor", j.floored.F},
          {"floor_order", j.floored.order},
          {"floor_low", j.floored.low},
          {"floor_high", j.floored.high},
          {"leave_one_out", j.leave_one_out.change},
          {"leave_one_out_level", std::isnan(j.leave_one_out.change) ? not_estimated : number(j.leave_one_out.level)}};
}

std::string findings_key(const Study& study) {
  // A study's runs and measurements can come from other study files that it names.
  std::uint64_t runs = checksum({});
  for (const Series& series : study.series) {
    runs = checksum(series.label() + series.theory.statement + std::string(name_of(series.expected)), runs);
    for (const Case& c : series.cases) runs = checksum(storage_key(c), runs);
  }
  for (const Measurement& measurement : study.measurements) runs = checksum(measurement.name, runs);
  return fmt::format("runs={:016x}|{}|measurements={}", runs, study.text, measurements_fingerprint());
}

bool of_these_measurements(const std::string& findings_key) {
  return findings_key.ends_with("|measurements=" + measurements_fingerprint());
}

std::string absolute_path(const std::string& file) {
  std::error_code error;
  const fs::path path = fs::weakly_canonical(file, error);
  return error ? file : fs::absolute(path, error).string();
}

std::string storage_key(const Case& c) { return c.key() + "|numerics=" + numerics_fingerprint(); }

StoredCases load_cases(const fs::path& file) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  StoredCases stored;
  if (fs::exists(file)) {
    try {
      read_results(file, stored);
    } catch (const StoreLocked&) {
      throw;
    } catch (const std::exception& error) {
      throw StoreError(
          fmt::format("{}: not a readable result file ({}); remove it, or use --fresh", file.string(), error.what()));
    }
  }
  read_journal(journal_path(file.parent_path(), file.stem().string()), stored);
  return stored;
}

void write_results(const fs::path& out, const StudyResult& result, const Provenance& provenance) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  replace_atomically(out / (result.study->name + ".h5"), h5_image(result, provenance));
  replace_atomically(out / (result.study->name + ".json"), json_text(result, provenance));
  std::error_code ignored;
  fs::remove(journal_path(out, result.study->name), ignored);
}

}  // namespace acstudy
