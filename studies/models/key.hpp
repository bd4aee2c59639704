#pragma once

/// @file
/// Keys of the tables of a study file: what a reader allows is what `acstudy list keys` prints.

#include <span>
#include <string_view>

namespace acstudy {

struct Key {
  std::string_view name;     ///< "kernel.alpha" stands in an inline table, the value of "kernel"
  std::string_view written;  ///< what its value may be
  std::string_view meaning;
  std::string_view left_out = "needed";  ///< what holds without it
};

struct TableKeys {
  std::string_view title;  ///< as it stands in a study file, "[time]" or "[[path]]"
  std::span<const Key> keys;
  bool optional = false;

  std::string_view name() const {
    const std::size_t first = title.find_first_not_of('[');
    return title.substr(first, title.find(']') - first);
  }
};

}  // namespace acstudy
