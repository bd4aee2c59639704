#pragma once

/// @file
/// Memory as a reader wants it.

#include <fmt/format.h>

#include <string>

namespace acstudy {

/// With two significant digits: "2.4 MB", "31 GB".
inline std::string bytes_text(double bytes) {
  const char* unit = "kB";
  bytes /= 1e3;
  for (const char* const larger : {"MB", "GB", "TB", "PB"}) {
    if (bytes < 999.5) break;
    bytes /= 1e3;
    unit = larger;
  }
  return bytes < 9.95 ? fmt::format("{:#.2g} {}", bytes, unit) : fmt::format("{:.0f} {}", bytes, unit);
}

}  // namespace acstudy
