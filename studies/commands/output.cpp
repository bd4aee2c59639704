#include "studies/commands/output.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "studies/reading/input_error.hpp"

namespace acstudy {

namespace fs = std::filesystem;

namespace {

/// What keeps a file from being made in a folder; empty if nothing does.
std::string why_not_writable(const fs::path& folder) {
  const fs::path probe = folder / ".acstudy-writable";
  std::FILE* const file = std::fopen(probe.c_str(), "w");
  if (file == nullptr) return std::strerror(errno);
  std::fclose(file);
  std::error_code ignored;
  fs::remove(probe, ignored);
  return "";
}

}  // namespace

void prepare_folder(const fs::path& out) {
  std::error_code error;
  fs::create_directories(out, error);
  if (const std::string why = error ? error.message() : why_not_writable(out); !why.empty()) {
    throw InputError(
        fmt::format("{}: cannot write to the output folder: {}; name another one with --out", out.string(), why));
  }
}

void require_writable(const fs::path& file) {
  std::error_code ignored;
  const bool replaceable = !fs::exists(file, ignored) || fs::is_regular_file(file, ignored);
  std::string why;
  if (!file.has_filename()) {
    why = "it has no name";
  } else if (file.extension() == ".json") {
    why = "a result file has such a name";
  } else if (!replaceable) {
    why = "there is something that is no regular file";
  } else {
    why = why_not_writable(file.parent_path().empty() ? "." : file.parent_path());
  }
  if (why.empty()) return;
  throw InputError(
      fmt::format("{}: cannot write the JUnit file: {}; name another one with --junit", file.string(), why));
}

}  // namespace acstudy
