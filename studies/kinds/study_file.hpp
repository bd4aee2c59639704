#pragma once

/// @file
/// Study files, read and checked.

#include <string>
#include <vector>

#include "studies/cases/study.hpp"
#include "studies/reading/input_error.hpp"

namespace acstudy {

/// Reads a study file and checks all of it, every case included.
/// @throws InputError
Study read_study(const std::string& file);

/// The same for several, whose names must differ.
std::vector<Study> read_studies(const std::vector<std::string>& files);

/// The same from text; `file` is what messages name.
Study parse_study(const std::string& text, const std::string& file);

}  // namespace acstudy
