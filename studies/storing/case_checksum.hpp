#pragma once

/// @file
/// A checksum of a stored case: by its values, wherever they are stored.

#include <cstring>
#include <string>

#include "studies/cases/case_result.hpp"
#include "studies/cases/checksum.hpp"

namespace acstudy {

/// The bytes of a value of a record.
template <class T, class Visit>
void with_bytes(const T& value, Visit&& visit) {
  if constexpr (std::is_arithmetic_v<T>) {
    visit(std::span(reinterpret_cast<const char*>(&value), sizeof value));
  } else if constexpr (std::is_same_v<T, std::string>) {
    visit(std::span(value.data(), std::strlen(value.c_str())));  // what stores keep of a text
  } else if constexpr (std::is_same_v<T, PointArray>) {
    with_bytes(value.dimension, visit);
    with_bytes(value.coordinates, visit);
  } else {
    visit(std::span(reinterpret_cast<const char*>(value.data()), value.size() * sizeof(typename T::value_type)));
  }
}

/// Of what is the same in every run of a case, and of what is not.
struct CaseChecksum {
  std::int64_t numbers = 0, times = 0;
  bool operator==(const CaseChecksum&) const = default;
};

/// @param key             its storage key
/// @param with_reference  false: without `u_exact`, which is found anew where it is the solution of a reference
inline CaseChecksum case_checksum(const std::string& key, const CaseResult& result, bool with_reference) {
  std::uint64_t numbers = checksum(key), times = numbers;
  CaseResult::stored(result, [&]<class T>(const Stored& as, const T& value) {
    if (!with_reference && as.column() == "u_exact") return;
    std::uint64_t& sum = as.timed ? times : numbers;
    with_bytes(value, [&](std::span<const char> bytes) {
      if (!bytes.empty()) sum = checksum(bytes, checksum(as.column(), sum));
    });
  });
  return {static_cast<std::int64_t>(numbers), static_cast<std::int64_t>(times)};
}

}  // namespace acstudy
