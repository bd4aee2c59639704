#pragma once

/// @file
/// The one way in which JSON is written.

#include <nlohmann/json.hpp>
#include <string>

namespace acstudy::json_form {

/// JSON text with every real number at 17 significant digits, where the library writes the fewest that read back the
/// same, and null for one that is not finite: JSON has no infinity and no NaN.
std::string pretty(const nlohmann::ordered_json& value);

}  // namespace acstudy::json_form
