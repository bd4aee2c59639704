#pragma once

/// @file
/// Normal random numbers that are the same with every standard library.

#include <gsl/gsl_cdf.h>

#include <random>

namespace acstudy {

/// Uniform on (0, 1), from the upper bits of the generator; the distributions of the library differ by vendor.
inline double uniform(std::mt19937_64& generator) { return (static_cast<double>(generator() >> 12) + 0.5) * 0x1p-52; }

inline double normal(std::mt19937_64& generator) { return gsl_cdf_ugaussian_Pinv(uniform(generator)); }

}  // namespace acstudy
