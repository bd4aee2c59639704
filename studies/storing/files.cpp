#include "studies/storing/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <random>

#include "studies/storing/store_error.hpp"

namespace acstudy {

namespace fs = std::filesystem;

void cannot_be_written(const fs::path& file, int error) {
  throw StoreError(
      fmt::format("{}: cannot be written: {}; free space or name another place", file.string(), std::strerror(error)));
}

namespace {

/// How names of files end that are being written.
constexpr std::string_view partial = ".partial";

/// A name that no other process makes: numbers of processes are the same in two containers.
fs::path temporary_beside(const fs::path& file) {
  std::random_device random;
  return file.string() + fmt::format(".{:08x}{:08x}{}", random(), random(), partial);
}

/// So that a name that a folder has got outlasts a loss of power; not all file systems can.
void keep_names(const fs::path& folder) {
  const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

}  // namespace

int write_all(int descriptor, std::span<const char> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return 0;
}

void replace_atomically(const fs::path& file, std::span<const char> content) {
  const fs::path temporary = temporary_beside(file);
  const int descriptor = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) cannot_be_written(file, errno);
  int error = write_all(descriptor, content);
  if (error == 0 && fsync(descriptor) != 0) error = errno;
  if (close(descriptor) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(temporary.c_str(), file.c_str()) != 0) error = errno;
  if (error == 0) return keep_names(file.parent_path());
  unlink(temporary.c_str());
  cannot_be_written(file, error);
}

void remove_partial(const fs::path& folder, const std::set<std::string>& files) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (!name.ends_with(partial)) continue;
    const std::size_t dot = name.rfind('.', name.size() - partial.size() - 1);
    if (dot == std::string::npos || files.count(name.substr(0, dot)) == 0) continue;
    std::error_code ignored;
    fs::remove(it->path(), ignored);
  }
}

std::vector<char> bytes_of(const fs::path& file) {
  const auto fails = [&] {
    throw StoreError(fmt::format("{}: cannot be read: {}; see who may read it", file.string(), std::strerror(errno)));
  };
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fails();
  std::vector<char> bytes;
  ssize_t count = 0;
  do {
    constexpr std::size_t at_once = std::size_t{1} << 22;
    const std::size_t size = bytes.size();
    bytes.resize(size + at_once);
    do {
      count = read(descriptor, bytes.data() + size, at_once);
    } while (count < 0 && errno == EINTR);
    bytes.resize(size + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  } while (count > 0);
  const int error = errno;
  close(descriptor);
  errno = error;
  if (count < 0) fails();
  return bytes;
}

std::string absolute_path(const std::string& file) {
  std::error_code error;
  const fs::path path = fs::weakly_canonical(file, error);
  return error ? file : fs::absolute(path, error).string();
}

}  // namespace acstudy
