#pragma once

/// @file
/// Computes stored results anew and compares.

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace acstudy {

struct VerifyOptions {
  std::optional<std::size_t> sample = 10;  ///< so many cases and findings of a result; nothing: all
  double tolerance = 0.0;                  ///< of numbers, relative to the largest of their kind; 0: bitwise
  int jobs = 1;
};

/// What came of it.
struct Verified {
  std::size_t computed = 0, stored = 0;  ///< cases and findings
  std::vector<std::string> differ;       ///< by name, and what differs
  double largest = 0.0;                  ///< relative difference of numbers
  bool interrupted = false, left_running = false;
};

/// Computes cases and findings of a result file from the study text that is stored with it. Which, if not all, follows
/// from their names, and is the same every time. Findings that rest on cases of their study are taken from the stored
/// ones.
/// @throws StoreError, InputError if the text is no study to this program
Verified verify(const std::filesystem::path& file, const VerifyOptions& options, const std::atomic<bool>& stop);

}  // namespace acstudy
