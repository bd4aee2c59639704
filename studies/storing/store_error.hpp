#pragma once

/// @file
/// What a store that cannot be used throws.

#include <stdexcept>

namespace acstudy {

/// The machine failed the store: disk full, unreadable file, no permission.
class StoreError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Another process has the file open for writing, so that it can be neither read nor called broken.
class StoreLocked : public StoreError {
 public:
  using StoreError::StoreError;
};

}  // namespace acstudy
