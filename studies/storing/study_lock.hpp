#pragma once

/// @file
/// Keeps two processes from writing the same results.

#include <filesystem>
#include <string>

namespace acstudy {

/// `<folder>/<name>.lock`, held to the end of its life or of the process, whatever ends it. The file says who holds it,
/// and is gone when nobody does, unless its holder was killed.
class StudyLock {
 public:
  /// Waits some two seconds for another process.
  /// @throws StoreLocked with its word on who holds it, if it does not end
  StudyLock(std::filesystem::path folder, const std::string& name);
  StudyLock(StudyLock&& other) noexcept;
  StudyLock(const StudyLock&) = delete;
  StudyLock& operator=(const StudyLock&) = delete;
  StudyLock& operator=(StudyLock&&) = delete;
  ~StudyLock();

  /// Why the folder cannot be locked, if its file system has no locks; then nothing is held.
  const std::string& without() const { return without_; }
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
  std::string without_;
};

/// @throws StoreLocked if another process holds the lock of this name, for more than some two seconds
void require_unlocked(const std::filesystem::path& folder, const std::string& name);
/// The same of all locks of a study in a folder, its own and those of shards.
/// @param but  one that this process holds
void require_no_writer(const std::filesystem::path& folder, const std::string& study, const StudyLock* but = nullptr);

}  // namespace acstudy
