#pragma once

/// @file
/// The one way in which JSON is written.

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

/// JSON text with every real number at 17 significant digits, where the library writes the fewest that read back the
/// same, and null for one that is not finite: JSON has no infinity and no NaN.
std::string pretty(const nlohmann::ordered_json& value);

}  // namespace acstudy::json_form
