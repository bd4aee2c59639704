#include "studies/storing/study_h5.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <thread>
#include <utility>

#include "build_info.hpp"
#include "studies/cases/series_verdict.hpp"
#include "studies/storing/apart.hpp"
#include "studies/storing/case_h5.hpp"
#include "studies/storing/content_checksum.hpp"
#include "studies/storing/files.hpp"
#include "studies/storing/finding_h5.hpp"
#include "studies/storing/journal.hpp"
#include "studies/storing/journal_record.hpp"
#include "studies/storing/keys.hpp"
#include "studies/storing/result_record.hpp"
#include "studies/storing/seal.hpp"

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

/// Waits some two seconds for a file that is locked, unless HDF5 is told to heed no locks.
void await_unlocked(const fs::path& file) {
  const char* const heeds = std::getenv("HDF5_USE_FILE_LOCKING");
  if (heeds != nullptr && (heeds == std::string("FALSE") || heeds == std::string("0"))) return;
  for (int tries = 0; locked(file); ++tries) {
    if (tries == 8) {
      throw StoreLocked(fmt::format(
          "{}: locked: another program holds it open for writing; close it there, or name another folder with --out",
          file.string()));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(250));
  }
}

void require_format(hid_t root) {
  const std::string found = h5::read_text(root, "format");
  if (found == format) return;
  constexpr std::string_view ours = "acstudy-";
  const std::string number = found.starts_with(ours) ? found.substr(ours.size()) : "";
  const bool newer = !number.empty() && number.find_first_not_of("0123456789") == number.npos && number != "0";
  throw StoreError(newer ? fmt::format("its format {} is that of a newer version, this one knows {}", found, format)
                         : fmt::format("its format is not {}", format));
}

/// A result file, read at once: it has thousands of small objects. @throws StoreError if it is not as it was written
h5::Handle open_whole(const fs::path& file) {
  await_unlocked(file);
  const std::vector<char> bytes = bytes_of(file);
  if (seal_of(bytes) == Seal::broken) throw StoreError("it is not as it was written");
  h5::Handle root = h5::open_image(bytes);
  require_format(root);
  return root;
}

/// Of what a file says of itself besides series and findings.
std::int64_t checksum_of_origin(hid_t root) {
  std::uint64_t sum = attributes_checksum(root);
  for (const char* const group : {"provenance", "scene"}) {
    if (H5Lexists(root, group, H5P_DEFAULT) > 0) sum = attributes_checksum(h5::open_group(root, group), sum);
  }
  return static_cast<std::int64_t>(sum);
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

[[noreturn]] void is_not_readable(const std::string& file, const std::exception& error) {
  throw StoreError(
      fmt::format("{}: not a readable result file ({}); name one that acstudy run has written", file, error.what()));
}

}  // namespace

std::vector<char> study_h5(const StudyResult& result, const Provenance& provenance, const std::string& json_seal) {
  const Study& study = *result.study;
  const h5::Handle root = h5::create_file_in_memory();
  h5::write_text(root, "format", format);
  h5::write_text(root, "json_seal", json_seal);
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
  h5::write_number(root, "checksum", checksum_of_origin(root));
  return sealed(h5::image(root));
}

ResultRecord stated_h5(const std::string& file) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  ResultRecord all;
  try {
    const h5::Handle root = open_whole(file);
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
    is_not_readable(file, error);
  }
  return all;
}

StudyOrigin study_of_h5(const fs::path& file) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  try {
    const h5::Handle root = open_whole(file);
    return {h5::read_text(root, "study"), h5::read_text(root, "study_file"), h5::read_text(root, "study_text"), file};
  } catch (const StoreLocked&) {
    throw;
  } catch (const std::exception& error) {
    is_not_readable(file.string(), error);
  }
}

namespace {

/// Reads the parts of a result file one after the other.
class Reader {
 public:
  /// @param trusted     the file is as it was written; otherwise what is not is left out and named
  /// @param after_part  is called when something has been added to `stored`
  Reader(hid_t root, std::string file, bool trusted, StoredCases& stored, std::function<void()> after_part)
      : root_(root), file_(std::move(file)), trusted_(trusted), stored_(stored), after_part_(std::move(after_part)) {}

  void read(bool any_sources) {
    bool these_sources = true;
    part("where it comes from", [&] { these_sources = read_origin(); });
    if (these_sources || any_sources) part("its series", [&] { read_series(); });
    if (any_sources || (these_sources && (!trusted_ || of_these_measurements(stored_.findings_key)))) {
      part("its findings", [&] { read_findings(); });
    }
  }

 private:
  template <class Read>
  void part(const std::string& what, Read&& read) {
    try {
      read();
    } catch (const std::exception&) {
      if (trusted_) throw;
      stored_.damaged.push_back(fmt::format("{}: {}", file_, what));
    }
    after_part_();
  }

  void require_checksum(hid_t object, std::int64_t sum) const {
    if (h5::read_number<std::int64_t>(object, "checksum") != sum) throw StoreError("it is damaged");
  }

  /// False if the file is of other sources than this program.
  bool read_origin() {
    if (!trusted_) require_checksum(root_, checksum_of_origin(root_));
    if (H5Aexists(root_, "study_file") > 0) {
      stored_.study_file = h5::read_text(root_, "study_file");
      stored_.study_text = h5::read_text(root_, "study_text");
    }
    h5::read(root_, "json_seal", stored_.json_seal);
    const h5::Handle origin = h5::open_group(root_, "provenance");
    // Nothing that other sources have computed is used again, and they may have stored it in another way.
    if (h5::read_text(origin, "numerics") != build_info::numerics) return false;
    for (const auto& [name, value] : collect_provenance(0, ""))
      stored_.provenance.emplace_back(name, h5::read_text(origin, name));
    // Findings of other sources are not used again, so they need not be readable; older files have none.
    if (H5Aexists(root_, "findings_key") > 0) stored_.findings_key = h5::read_text(root_, "findings_key");
    return true;
  }

  void read_series() {
    const h5::Handle all = h5::open_group(root_, "series");
    for (const std::string& name : h5::group_names(all)) {
      part("series " + name, [&] {
        std::vector<std::int64_t> damaged;
        const h5::Handle group = h5::open_group(all, name);
        read_cases(group, trusted_, stored_, damaged);
        if (H5Lexists(group, "reference", H5P_DEFAULT) > 0) {
          read_cases(h5::open_group(group, "reference"), trusted_, stored_, damaged);
        }
        for (const std::int64_t N : damaged) {
          stored_.damaged.push_back(fmt::format("{}: series {}, N = {}", file_, name, N));
        }
      });
    }
  }

  void read_findings() {
    const h5::Handle findings = h5::open_group(root_, "findings");
    for (const std::string& name : h5::group_names(findings)) {
      part("finding " + name, [&] {
        const h5::Handle group = h5::open_group(findings, name);
        if (!trusted_) require_checksum(group, content_checksum(group));
        stored_.findings.emplace(std::stoul(name), read_finding(group));
      });
    }
  }

  hid_t root_;
  std::string file_;
  bool trusted_;
  StoredCases& stored_;
  std::function<void()> after_part_;
};

/// What is whole of a damaged file, as records of a journal. HDF5 can crash over such a file, so that a process of its
/// own reads it; what that has written is what it found.
void read_damaged(const std::vector<char>& bytes, const std::string& file, bool any_sources, StoredCases& stored) {
  const auto read = [&](int to) {
    StoredCases found;
    const auto hand_on = [&] {
      const auto write = [&](const RecordBytes& record) { write_all(to, framed(record)); };
      if (!found.study_text.empty()) write(origin_record(found));
      found.study_text.clear();
      for (const auto& [key, result] : found.cases) write(case_record(key, result));
      for (const auto& [number, finding] : found.findings) write(finding_record(found.findings_key, number, finding));
      for (const std::string& what : found.damaged) write(damage_record(what));
      found.cases.clear();
      found.findings.clear();
      found.damaged.clear();
    };
    const h5::Handle root = h5::open_image(bytes);
    require_format(root);
    Reader(root, file, false, found, hand_on).read(any_sources);
  };
  const std::vector<char> records = written_apart(read);
  const std::size_t before = stored.damaged.size();
  read_records(records, stored);
  if (stored.cases.empty() && stored.findings.empty() && stored.study_text.empty()) {
    throw StoreError("it is not as it was written, and nothing of it is whole");
  }
  if (stored.damaged.size() == before) stored.damaged.push_back(file + ": something in it");
}

}  // namespace

void read_study_h5(const fs::path& file, bool any_sources, StoredCases& stored) {
  await_unlocked(file);
  const std::vector<char> bytes = bytes_of(file);
  const Seal seal = seal_of(bytes);
  if (seal == Seal::broken) return read_damaged(bytes, file.string(), any_sources, stored);
  const h5::Handle root = h5::open_image(bytes);
  require_format(root);
  Reader(root, file.string(), true, stored, [] {}).read(any_sources);
  stored.whole = seal == Seal::whole;
}

}  // namespace acstudy
