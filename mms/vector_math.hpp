#pragma once

/// @file
/// Elementary functions of whole vectors, where the C library has them.
///
/// The GNU C library's vector variants of sin, cos, exp, log and atan2 (libmvec, at most 4 units in the last place)
/// are offered to the compiler here, for the translation units that include this header and for no other; so these are
/// the only places where a function value may differ from the scalar library's. Everywhere else, and with other C
/// libraries, <cmath> is used.

#include <cmath>
#include <cstddef>

#include "solver/clones.hpp"

#if defined(__GLIBC__) && defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
extern "C" {
__attribute__((simd("notinbranch"))) double sin(double) noexcept;
__attribute__((simd("notinbranch"))) double cos(double) noexcept;
__attribute__((simd("notinbranch"))) double exp(double) noexcept;
__attribute__((simd("notinbranch"))) double log(double) noexcept;
#if __GLIBC_PREREQ(2, 35)
__attribute__((simd("notinbranch"))) double atan2(double, double) noexcept;
#endif
}
#endif

namespace acstudy {

/// Loops over blocks run to a multiple of this, so that every element takes the same path.
inline constexpr std::size_t vector_width = 8;

}  // namespace acstudy
