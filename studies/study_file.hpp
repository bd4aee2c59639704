#pragma once

/// @file
/// Study files, read and checked.

#include <stdexcept>
#include <string>

#include "studies/study.hpp"

namespace acstudy {

/// Bad input; `what()` is the complete message "FILE:LINE:COL: what is wrong, the value received, the remedy".
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads a study file and checks all of it, every case included.
/// @throws InputError
Study read_study(const std::string& file);

/// The same from text; `file` is what messages name.
Study parse_study(const std::string& text, const std::string& file);

}  // namespace acstudy
