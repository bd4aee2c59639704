#include "studies/storing/journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "studies/cases/checksum.hpp"
#include "studies/storing/files.hpp"
#include "studies/storing/journal_record.hpp"
#include "studies/storing/keys.hpp"
#include "studies/storing/store_error.hpp"

namespace acstudy {

namespace {

namespace fs = std::filesystem;

/// How a record begins. Its size and its checksum follow, then its bytes.
constexpr std::string_view mark =
    "\n\x89"
    "acstudy-rec-2\n";
struct Head {
  std::uint64_t size, checksum;
};
constexpr std::size_t head_size = mark.size() + sizeof(Head);

std::span<const char> as_chars(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void append(std::vector<char>& to, std::span<const std::uint8_t> bytes) {
  const Head head{bytes.size(), checksum(as_chars(bytes))};
  const auto* const head_begin = reinterpret_cast<const char*>(&head);
  to.insert(to.end(), mark.begin(), mark.end());
  to.insert(to.end(), head_begin, head_begin + sizeof head);
  to.insert(to.end(), bytes.begin(), bytes.end());
}

}  // namespace

fs::path journal_path(const fs::path& out, const std::string& study, const std::string& shard) {
  return out / fmt::format("{}{}.journal", study, shard);
}

std::vector<char> journal_head(const Study& study) {
  std::vector<char> record;
  append(record, study_record(study));
  return record;
}

std::vector<char> journal_records(const StudyResult& result, const Finished& finished) {
  std::vector<char> records;
  for (const auto& [c, r] : finished.cases) append(records, case_record(storage_key(*c), *r));
  if (finished.findings.empty()) return records;
  const std::string key = findings_key(*result.study);
  for (const std::size_t i : finished.findings) append(records, finding_record(key, i, *result.findings[i]));
  return records;
}

void append_to_journal(const fs::path& file, std::span<const char> records) {
  const int journal = open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  int error = journal < 0 ? errno : 0;
  if (error == 0) {
    struct stat before {};
    fstat(journal, &before);
    error = write_all(journal, records);
    if (error == 0 && fsync(journal) != 0) error = errno;
    if (error != 0 && ftruncate(journal, before.st_size) == 0 && before.st_size == 0) unlink(file.c_str());
    close(journal);
  }
  if (error == 0) return;
  cannot_be_written(file, error);
}

namespace {

/// Calls visit(bytes) for each record that is as it was written, until it returns false. Returns how many are not; one
/// that is cut off at the end, as by a kill, is none.
template <class Visit>
std::size_t for_each_record(std::span<const char> all, Visit&& visit) {
  std::size_t damaged = 0;
  for (auto at = all.begin(); (at = std::search(at, all.end(), mark.begin(), mark.end())) != all.end(); ++at) {
    const auto rest = all.subspan(static_cast<std::size_t>(at - all.begin()));
    if (rest.size() < head_size) break;
    Head head;
    std::memcpy(&head, rest.data() + mark.size(), sizeof head);
    if (head.size > rest.size() - head_size) continue;
    const auto bytes = rest.subspan(head_size, static_cast<std::size_t>(head.size));
    if (checksum(bytes) != head.checksum) {
      ++damaged;
      continue;
    }
    if (!visit(std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()))) break;
    at += static_cast<std::ptrdiff_t>(head_size + head.size) - 1;
  }
  return damaged;
}

[[noreturn]] void is_not_readable(const fs::path& file, const std::exception& error) {
  throw StoreError(
      fmt::format("{}: not a readable journal ({}); remove it, or use --fresh", file.string(), error.what()));
}

}  // namespace

std::vector<char> framed(std::span<const std::uint8_t> record) {
  std::vector<char> bytes;
  append(bytes, record);
  return bytes;
}

std::size_t read_records(std::span<const char> records, StoredCases& stored) {
  return for_each_record(records, [&](std::span<const std::uint8_t> record) {
    add_record(record, stored);
    return true;
  });
}

void read_journal(const fs::path& file, StoredCases& stored) {
  const std::vector<char> content = bytes_of(file);
  try {
    const std::size_t damaged = read_records(content, stored);
    if (damaged > 0) stored.damaged.push_back(fmt::format("{}: {} of its records", file.string(), damaged));
  } catch (const std::exception& error) {
    is_not_readable(file, error);
  }
}

StoredCases journal_origin(const fs::path& file) {
  const std::vector<char> content = bytes_of(file);
  StoredCases origin;
  try {
    for_each_record(content, [&](std::span<const std::uint8_t> record) {
      add_record(record, origin);
      return origin.study_text.empty();
    });
  } catch (const std::exception& error) {
    is_not_readable(file, error);
  }
  return origin;
}

std::vector<fs::path> journals_of(const fs::path& folder, const std::string& study) {
  std::vector<fs::path> journals;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (study_of_journal(name) == study) journals.push_back(it->path());
  }
  std::sort(journals.begin(), journals.end());
  return journals;
}

std::string study_of_journal(const std::string& name) {
  if (!name.ends_with(".journal")) return "";
  return name.substr(0, name.find('.'));
}

}  // namespace acstudy
