#pragma once

/// @file
/// What is thrown for input that is not usable.

#include <stdexcept>

namespace acstudy {

/// Bad input; `what()` is the complete message "FILE:LINE:COL: what is wrong, the value received, the remedy".
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace acstudy
