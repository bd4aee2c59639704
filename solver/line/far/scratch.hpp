#pragma once

/// @file
/// Memory that is kept from one sweep to the next.

#include <cstddef>
#include <memory>

namespace acstudy::far {

/// Doubles at an address that is a multiple of 64.
class Scratch {
 public:
  /// At least `size` doubles, of any value. The memory given before is no longer valid.
  double* reserve(std::ptrdiff_t size);

 private:
  struct Free {
    void operator()(double* memory) const;
  };
  std::unique_ptr<double, Free> memory_;
  std::ptrdiff_t size_ = 0;
};

}  // namespace acstudy::far
