#pragma once

/// @file
/// A checksum for what a disk or a change may have altered; no protection against intent.

#include <cstdint>
#include <span>

namespace acstudy {

/// FNV-1a of 64 bits. @param sum  that of what comes before
inline std::uint64_t checksum(std::span<const char> bytes, std::uint64_t sum = 0xcbf29ce484222325) {
  for (const char byte : bytes) sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
  return sum;
}

}  // namespace acstudy
