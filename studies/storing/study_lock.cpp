#include "studies/storing/study_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <thread>
#include <utility>

#include "studies/storing/files.hpp"
#include "studies/storing/store_error.hpp"

namespace acstudy {

namespace fs = std::filesystem;

namespace {

fs::path lock_file(const fs::path& folder, const std::string& name) { return folder / (name + ".lock"); }

/// "process 4711 on node3 since 2026-01-31 12:00:00"
std::string me() {
  std::array<char, 256> host{}, since{};
  gethostname(host.data(), host.size() - 1);
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  std::strftime(since.data(), since.size(), "%Y-%m-%d %H:%M:%S", localtime_r(&now, &local));
  return fmt::format("process {} on {} since {}", getpid(), host.data(), since.data());
}

/// What the holder has written; it may be about to.
std::string holder(int descriptor) {
  std::array<char, 512> text{};
  const ssize_t count = pread(descriptor, text.data(), text.size() - 1, 0);
  std::string who(text.data(), static_cast<std::size_t>(count > 0 ? count : 0));
  who.erase(std::min(who.find('\n'), who.size()));
  return who.empty() ? "another process" : who;
}

/// Whether the file that is open is still the one of this name: whoever held it may have removed it.
bool in_place(int descriptor, const fs::path& file) {
  struct stat opened {
  }, named{};
  return fstat(descriptor, &opened) == 0 && stat(file.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

[[noreturn]] void is_held(const fs::path& file, int descriptor) {
  const std::string who = holder(descriptor);
  close(descriptor);
  throw StoreLocked(
      fmt::format("{}: locked by {}, which writes these results; wait for its end, or name another "
                  "folder with --out",
                  file.string(), who));
}

/// Whether an error says that there are no locks, and not that one is held.
bool no_locks(int error) { return error != EWOULDBLOCK && error != EINTR; }

constexpr int most_tries = 40;
void wait_a_little() { std::this_thread::sleep_for(std::chrono::milliseconds(50)); }

}  // namespace

StudyLock::StudyLock(fs::path folder, const std::string& name) : file_(lock_file(folder, name)) {
  for (int tries = 0;; ++tries) {
    const int descriptor = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0) cannot_be_written(file_, errno);
    if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) {
      if (in_place(descriptor, file_)) {
        descriptor_ = descriptor;
        break;
      }
    } else if (no_locks(errno)) {
      without_ = std::strerror(errno);
      close(descriptor);
      unlink(file_.c_str());
      return;
    } else if (tries == most_tries) {
      is_held(file_, descriptor);
    } else {
      wait_a_little();
    }
    close(descriptor);
  }
  // That nobody can read who holds it is no reason not to hold it.
  const std::string text = me() + "\n";
  if (ftruncate(descriptor_, 0) == 0) write_all(descriptor_, text);
}

StudyLock::StudyLock(StudyLock&& other) noexcept
    : file_(std::move(other.file_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      without_(std::move(other.without_)) {}

StudyLock::~StudyLock() {
  if (descriptor_ < 0) return;
  unlink(file_.c_str());
  close(descriptor_);
}

namespace {

void require_unlocked(const fs::path& file) {
  for (int tries = 0;; ++tries) {
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return;
    const bool held = flock(descriptor, LOCK_SH | LOCK_NB) != 0 && !no_locks(errno);
    if (held && tries == most_tries) is_held(file, descriptor);
    close(descriptor);
    if (!held) return;
    wait_a_little();
  }
}

}  // namespace

void require_unlocked(const fs::path& folder, const std::string& name) { require_unlocked(lock_file(folder, name)); }

void require_no_writer(const fs::path& folder, const std::string& study, const StudyLock* but) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const fs::path& file = it->path();
    const std::string name = file.filename().string();
    const bool of_study = name.ends_with(".lock") && name.substr(0, name.find('.')) == study;
    if (of_study && (but == nullptr || file != but->file())) require_unlocked(file);
  }
}

}  // namespace acstudy
