#include "studies/storing/study_h5.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>

#include "build_info.hpp"
#include "studies/cases/series_verdict.hpp"
#include "studies/storing/case_h5.hpp"
#include "studies/storing/files.hpp"
#include "studies/storing/finding_h5.hpp"
#include "studies/storing/keys.hpp"
#include "studies/storing/result_record.hpp"

namespace acstudy {

namespace {

namespace fs = std::filesystem;

constexpr const char* format = "acstudy-1";

void write_series(hid_t parent, const std::string& group_name, const SeriesResult& result, const Finding& verdict) {
  const Series& series = *result.series;
  const h5::Handle group = h5::create_group(parent, group_name);
  series.stored([&](const Stored& as, const auto& value) {
    if (as.column() != "theory_order") h5::write(group, as.column(), value);  // of the verdict, which has it
  });
  h5::write_number<std::int64_t>(group, "cases_planned", std::ssize(result.results));
  write_verdict(group, verdict);
  h5::write_column<double>(group, "pairwise", verdict.judgement.pairwise);

  write_cases(group, result, result.completed_levels());
  if (result.reference() != nullptr) {
    write_cases(h5::create_group(group, "reference"), result, std::vector{series.levels()});
  }
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

/// What a record of a series has besides the verdict.
void read_series(hid_t group, std::size_t number, FindingRecord& record) {
  record.cases = read_case_records(group);
  if (H5Lexists(group, "reference", H5P_DEFAULT) > 0) {
    for (CaseRecord& one : read_case_records(h5::open_group(group, "reference"))) {
      one.reference = true;
      record.cases.push_back(std::move(one));
    }
  }
  Finding& finding = record.finding;
  finding.series = number;
  finding.cases = {.planned = static_cast<std::size_t>(h5::read_number<std::int64_t>(group, "cases_planned")),
                   .run = record.cases.size()};
  finding.judgement.pairwise = h5::read_column<double>(group, "pairwise");
}

}  // namespace

std::vector<char> study_h5(const StudyResult& result, const Provenance& provenance) {
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
  h5::write_number(root, "findings_planned", std::ssize(study.measurements));
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
  std::vector<std::optional<Finding>> verdicts(result.series.size());
  for (const auto& finding : result.findings) {
    if (finding && finding->series) verdicts[*finding->series] = finding;
  }
  for (std::size_t i = 0; i < result.series.size(); ++i) {
    // What a series is evidence of shows its order, even where the gate asks for none.
    if (!verdicts[i]) verdicts[i] = series_verdict(*result.series[i].series, i).take(result.series);
    write_series(series, fmt::format("{:03}", i), result.series[i], *verdicts[i]);
  }
  const h5::Handle findings = h5::create_group(root, "findings");
  h5::write_text(root, "findings_key", findings_key(study));
  for (std::size_t i = 0; i < result.findings.size(); ++i) {
    if (result.findings[i] && !result.findings[i]->series)
      write_finding(findings, fmt::format("{:04}", i), *result.findings[i]);
  }
  return h5::image(root);
}

ResultRecord stated_h5(const std::string& file) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  ResultRecord all;
  try {
    const h5::Handle root = open_when_unlocked(file);
    if (h5::read_text(root, "format") != format) throw StoreError("its format is not " + std::string(format));
    all.study = h5::read_text(root, "study");
    const h5::Handle origin = h5::open_group(root, "provenance");
    for (const std::string& name : h5::attribute_names(origin)) {
      all.provenance.emplace_back(name, h5::read_text(origin, name));
    }
    const bool of_series = h5::read_text(root, "kind") == "convergence";
    const h5::Handle groups = h5::open_group(root, of_series ? "series" : "findings");
    for (const std::string& name : h5::group_names(groups)) {
      const h5::Handle group = h5::open_group(groups, name);
      FindingRecord record{all.study, read_stated(group)};
      record.verdict = name_of(record.finding.judgement.verdict);
      record.coordinates = read_coordinates(group);
      of_series ? read_series(group, all.findings.size(), record) : read_points(group, record.finding);
      all.findings.push_back(std::move(record));
    }
    std::int64_t planned = std::ssize(all.findings);
    h5::read(root, "findings_planned", planned);
    all.findings_planned = static_cast<std::size_t>(planned);
  } catch (const StoreLocked&) {
    throw;
  } catch (const std::exception& error) {
    throw StoreError(
        fmt::format("{}: not a readable result file ({}); name one that acstudy run has written", file, error.what()));
  }
  return all;
}

void read_study_h5(const fs::path& file, StoredCases& stored) {
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

}  // namespace acstudy
