#pragma once

/// @file
/// The one way in which JSON is written.

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "studies/cases/stored.hpp"

namespace acstudy::json_form {

/// Puts a value of a record in its place; no arrays, which are for HDF5.
template <class T>
void put(nlohmann::ordered_json& record, const Stored& as, const T& value) {
  if constexpr (!is_field<T>) {
    if (as.in_json) (*as.group == '\0' ? record : record[as.group])[as.name] = value;
  }
}

/// What `put` has put there, null being NaN. A value that is absent stays as it is.
/// @throws nlohmann::json::exception if what stands there is of another type
template <class T>
void take(const nlohmann::ordered_json& record, const Stored& as, T& value) {
  if constexpr (!is_field<T>) {
    const bool grouped = *as.group != '\0';
    if (grouped && !record.contains(as.group)) return;
    const nlohmann::ordered_json& place = grouped ? record.at(as.group) : record;
    const auto found = place.find(as.name);
    if (found == place.end()) return;
    if constexpr (std::is_same_v<T, double>) {
      value = found->is_null() ? std::numeric_limits<double>::quiet_NaN() : found->template get<double>();
    } else {
      value = found->template get<T>();
    }
  }
}

/// JSON text with every real number at 17 significant digits, where the library writes the fewest that read back the
/// same, and null for one that is not finite: JSON has no infinity and no NaN.
std::string pretty(const nlohmann::ordered_json& value);

}  // namespace acstudy::json_form
