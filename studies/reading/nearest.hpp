#pragma once

/// @file
/// What a user may have meant.

#include <string>
#include <string_view>
#include <vector>

namespace acstudy {

/// How many letters have to be put in, left out, replaced or swapped with their neighbor to make one word the other.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// "; did you mean "run"?" if one of the words is near to what was written, or begins with it; else nothing.
std::string did_you_mean(std::string_view written, const std::vector<std::string>& words);

}  // namespace acstudy
