#include "studies/storing/files.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "studies/storing/store_error.hpp"

namespace acstudy {

namespace fs = std::filesystem;

void cannot_be_written(const fs::path& file, int error) {
  throw StoreError(
      fmt::format("{}: cannot be written: {}; free space or name another place", file.string(), std::strerror(error)));
}

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
  cannot_be_written(file, error);
}

std::string absolute_path(const std::string& file) {
  std::error_code error;
  const fs::path path = fs::weakly_canonical(file, error);
  return error ? file : fs::absolute(path, error).string();
}

}  // namespace acstudy
