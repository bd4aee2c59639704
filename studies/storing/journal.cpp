#include "studies/storing/journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

#include "studies/cases/checksum.hpp"
#include "studies/storing/case_h5.hpp"
#include "studies/storing/files.hpp"
#include "studies/storing/finding_h5.hpp"
#include "studies/storing/keys.hpp"

namespace acstudy {

namespace {

namespace fs = std::filesystem;

/// How a record begins. Its size and its checksum follow, then the image of an HDF5 file.
constexpr std::string_view mark =
    "\n\x89"
    "acstudy-rec-1\n";
struct Head {
  std::uint64_t size, checksum;
};
constexpr std::size_t head_size = mark.size() + sizeof(Head);

void read_record(std::span<const char> image, StoredCases& stored) {
  const h5::Handle root = h5::open_image(image);
  stored.study_file = h5::read_text(root, "study_file");
  stored.study_text = h5::read_text(root, "study_text");
  const h5::Handle cases = h5::open_group(root, "cases");
  for (const std::string& name : h5::group_names(cases)) {
    const h5::Handle one = h5::open_group(cases, name);
    stored.cases.insert_or_assign(h5::read_text(one, "key"), read_case(one));
  }
  const std::string key = h5::read_text(root, "findings_key");
  if (!of_these_measurements(key)) return;
  if (key != stored.findings_key) stored.findings.clear();
  stored.findings_key = key;
  const h5::Handle findings = h5::open_group(root, "findings");
  for (const std::string& name : h5::group_names(findings)) {
    stored.findings.insert_or_assign(std::stoul(name), read_finding(h5::open_group(findings, name)));
  }
}

/// Writes all bytes. Returns errno, 0 if it went well.
int write_all(int file, std::span<const char> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(file, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return 0;
}

}  // namespace

fs::path journal_path(const fs::path& out, const std::string& study) { return out / (study + ".journal"); }

std::vector<char> journal_record(const StudyResult& result, const Finished& finished) {
  const Study& study = *result.study;
  const h5::Handle root = h5::create_file_in_memory(study.name + ".journal");
  h5::write_text(root, "study_file", absolute_path(study.file));
  h5::write_text(root, "study_text", study.text);
  h5::write_text(root, "findings_key", findings_key(study));
  const h5::Handle cases = h5::create_group(root, "cases"), findings = h5::create_group(root, "findings");
  for (std::size_t i = 0; i < finished.cases.size(); ++i) {
    const auto& [c, r] = finished.cases[i];
    write_case(cases, std::to_string(i), storage_key(*c), *r);
  }
  for (const std::size_t i : finished.findings) write_finding(findings, fmt::format("{:04}", i), *result.findings[i]);
  const std::vector<char> image = h5::image(root);

  const Head head{image.size(), checksum(image)};
  std::vector<char> record(head_size + image.size());
  std::copy(mark.begin(), mark.end(), record.begin());
  std::memcpy(record.data() + mark.size(), &head, sizeof head);
  std::copy(image.begin(), image.end(), record.begin() + head_size);
  return record;
}

void append_to_journal(const fs::path& file, std::span<const char> record) {
  const int journal = open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  int error = journal < 0 ? errno : 0;
  if (error == 0) {
    struct stat before {};
    fstat(journal, &before);
    error = write_all(journal, record);
    if (error == 0 && fsync(journal) != 0) error = errno;
    if (error != 0 && ftruncate(journal, before.st_size) == 0 && before.st_size == 0) unlink(file.c_str());
    close(journal);
  }
  if (error == 0) return;
  cannot_be_written(file, error);
}

void read_journal(const fs::path& file, StoredCases& stored) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return;
  std::ifstream in(file, std::ios::binary);
  const std::vector<char> content{std::istreambuf_iterator<char>(in), {}};
  if (!in) throw StoreError(fmt::format("{}: cannot be read; see who may read it", file.string()));
  const std::span<const char> all(content);
  for (auto at = all.begin(); (at = std::search(at, all.end(), mark.begin(), mark.end())) != all.end(); ++at) {
    const auto rest = all.subspan(static_cast<std::size_t>(at - all.begin()));
    if (rest.size() < head_size) return;
    Head head;
    std::memcpy(&head, rest.data() + mark.size(), sizeof head);
    if (head.size > rest.size() - head_size) continue;
    const auto image = rest.subspan(head_size, static_cast<std::size_t>(head.size));
    if (checksum(image) != head.checksum) continue;
    try {
      read_record(image, stored);
    } catch (const std::exception& error) {
      throw StoreError(
          fmt::format("{}: not a readable journal ({}); remove it, or use --fresh", file.string(), error.what()));
    }
    at += static_cast<std::ptrdiff_t>(head_size + head.size) - 1;
  }
}

}  // namespace acstudy
