#pragma once

/// @file
/// Files of NumPy, as far as they hold particles: one array of shape (2, N), positions and values.

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace acstudy {

struct PositionsAndValues {
  std::vector<double> x, u;
};

/// Writes little-endian float64 in C order.  @pre x and u are as long  @throws std::runtime_error
void write_npy(const std::filesystem::path& file, std::span<const double> x, std::span<const double> u);

/// @param count  N, which the array has to have
/// @throws std::runtime_error, which says what the file is not
PositionsAndValues read_npy(const std::filesystem::path& file, std::size_t count);

}  // namespace acstudy
