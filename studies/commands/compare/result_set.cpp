#include "studies/commands/compare/result_set.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <system_error>

#include "studies/commands/say.hpp"
#include "studies/reading/input_error.hpp"
#include "studies/storing/store_error.hpp"

namespace acstudy {

namespace {

namespace fs = std::filesystem;

ResultRecord read_file(const fs::path& file) {
  if (access(file.c_str(), R_OK) != 0) {
    throw StoreError(fmt::format("{}: cannot read the result file: {}", file.string(), std::strerror(errno)));
  }
  if (file.extension() == ".json") return stated_json(file.string());
  if (file.extension() == ".h5") return stated_h5(file.string());
  throw InputError(
      fmt::format("{}: a result file ends in .json or .h5; name one, or the folder that holds some", file.string()));
}

/// Throws if what a file states is no verdict; the gate counts that as one that departs.
void require_verdicts(const fs::path& file, const ResultRecord& study) {
  for (const FindingRecord& record : study.findings) {
    if (verdict_from(record.verdict)) continue;
    throw InputError(
        fmt::format("{}: not a result file of acstudy: \"{}\" has unknown verdict \"{}\"; run its study again",
                    file.string(), record.finding.label(), record.verdict));
  }
}

/// The result files of a folder, one of each name.
std::vector<fs::path> files_of(const fs::path& folder) {
  std::map<std::string, fs::path> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const fs::path& file = it->path();
    const std::string name = file.stem().string();
    if (name == "bench" || name.starts_with(".")) continue;
    if (file.extension() == ".json") files.insert_or_assign(name, file);
    if (file.extension() == ".h5") files.emplace(name, file);
  }
  if (error) throw StoreError(fmt::format("{}: cannot list the folder: {}", folder.string(), error.message()));
  std::vector<fs::path> all;
  for (const auto& [name, file] : files) all.push_back(file);
  if (all.empty()) {
    throw InputError(
        fmt::format("{}: no result file (.json, .h5) in the folder; name the one that acstudy run has written to",
                    folder.string()));
  }
  return all;
}

}  // namespace

ResultSet read_results(const std::string& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) {
    throw InputError(
        fmt::format("{}: no such file or folder; name a result file, or the folder that holds some", path));
  }
  ResultSet set{path, {}};
  std::map<std::string, fs::path> seen;
  for (const fs::path& file : fs::is_directory(path, ignored) ? files_of(path) : std::vector<fs::path>{path}) {
    set.studies.push_back(read_file(file));
    if (set.studies.back().damaged) say_damaged(file.string());
    require_verdicts(file, set.studies.back());
    const auto [first, is_new] = seen.emplace(set.studies.back().study, file);
    if (!is_new) {
      throw InputError(fmt::format("{}: study \"{}\" is also in {}; move one of them away", file.string(), first->first,
                                   first->second.string()));
    }
  }
  return set;
}

}  // namespace acstudy
