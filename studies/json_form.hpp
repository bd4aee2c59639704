#pragma once

/// @file
/// How result files write JSON.

#include <nlohmann/json.hpp>
#include <string>

namespace acstudy::json_form {

/// A real number; null for what is not finite.
nlohmann::ordered_json number(double value);

/// JSON text with every real number at 17 significant digits; the library writes the fewest that read back the same.
std::string pretty(const nlohmann::ordered_json& value);

}  // namespace acstudy::json_form
