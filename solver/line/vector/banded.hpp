#pragma once

/// @file
/// The product of a matrix of rates with u, several rows at a time.

#include "solver/line/vector/lanes.hpp"
#include "solver/line/vector/sweeps.hpp"

namespace acstudy {
inline namespace ACSTUDY_ISA {

inline void banded_sweep(const BandedMatrix::Block* blocks, const double* values, const double* u, double* rate,
                         std::ptrdiff_t begin, std::ptrdiff_t end) {
  for (std::ptrdiff_t block = begin; block < end; ++block) {
    const BandedMatrix::Block& band = blocks[block];
    const double* const value = values + band.begin;
    const double* const at_first = u + block * lane_count + band.first;
    Lanes even = {}, odd = {};
    std::ptrdiff_t k = 0;
    for (; k + 1 < band.width; k += 2) {
      even += load(value + k * lane_count) * load(at_first + k);
      odd += load(value + (k + 1) * lane_count) * load(at_first + k + 1);
    }
    if (k < band.width) even += load(value + k * lane_count) * load(at_first + k);
    store(rate + block * lane_count, even + odd);
  }
}

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
