#include "solver/line/far/scratch.hpp"

#include <new>

namespace acstudy::far {

namespace {
constexpr std::align_val_t alignment{64};
}

double* Scratch::reserve(std::ptrdiff_t size) {
  if (size > size_) {
    memory_.reset();
    size_ = 0;
    memory_.reset(static_cast<double*>(::operator new(static_cast<std::size_t>(size) * sizeof(double), alignment)));
    size_ = size;
  }
  return memory_.get();
}

void Scratch::Free::operator()(double* memory) const { ::operator delete(memory, alignment); }

}  // namespace acstudy::far
