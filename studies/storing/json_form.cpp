#include "studies/storing/json_form.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace acstudy::json_form {

using json = nlohmann::ordered_json;

namespace {

/// A value as JSON: null for a number that is not finite; bytes that are no UTF-8, as a file name may have, are
/// replaced.
std::string as_json_text(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

std::string pretty_at(const json& value, int depth) {
  const std::string inner(static_cast<std::size_t>(depth) * 2 + 2, ' '),
      outer(static_cast<std::size_t>(depth) * 2, ' ');
  const bool leaves = std::none_of(value.begin(), value.end(), [](const json& item) { return item.is_structured(); });
  const std::string separator = leaves ? ", " : ",\n" + inner, open = leaves ? " " : "\n" + inner,
                    close = leaves ? " " : "\n" + outer;
  if (value.is_number_float() && std::isfinite(value.get<double>())) return fmt::format("{:.17g}", value.get<double>());
  if (!value.is_structured() || value.empty()) return as_json_text(value);
  std::string text;
  for (const auto& [key, item] : value.items()) {
    text += text.empty() ? "" : separator;
    if (value.is_object()) text += as_json_text(key) + ": ";
    text += pretty_at(item, depth + 1);
  }
  return value.is_object() ? "{" + open + text + close + "}" : "[" + open + text + close + "]";
}

}  // namespace

std::string pretty(const json& value) { return pretty_at(value, 0); }

}  // namespace acstudy::json_form
