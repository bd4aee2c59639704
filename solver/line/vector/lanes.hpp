#pragma once

/// @file
/// Several particles at a time: what the vector form of the schemes computes with.
///
/// A source file that includes this is compiled once per instruction set, each time with another name for
/// ACSTUDY_ISA, so that nothing compiled for wide vectors can be called on a machine that has none.

#include <cstddef>
#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#ifndef ACSTUDY_ISA
#define ACSTUDY_ISA baseline
#endif

/// Sums must stay in registers, which they do only where the walk and what it visits become one function.
#define ACSTUDY_ALWAYS_INLINE __attribute__((always_inline))
/// For what runs long once called: a copy at every call takes the compiler a minute and gains nothing.
#define ACSTUDY_NEVER_INLINE __attribute__((noinline))

namespace acstudy {
inline namespace ACSTUDY_ISA {

#if defined(__AVX512F__)
inline constexpr int lane_count = 8;
#elif defined(__AVX2__)
inline constexpr int lane_count = 4;
#else
inline constexpr int lane_count = 2;
#endif

/// One double per particle, as many as the widest vectors of the instruction set hold.
using Lanes = double __attribute__((vector_size(lane_count * sizeof(double))));
/// Per lane all bits set or none; what comparing Lanes gives.
using Mask = std::int64_t __attribute__((vector_size(lane_count * sizeof(double))));

/// p need not be aligned.
inline Lanes load(const double* p) {
  Lanes v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
inline void store(double* p, Lanes v) { std::memcpy(p, &v, sizeof v); }

inline Lanes spread(double value) { return value - Lanes{}; }

inline constexpr unsigned all_bits = (1U << lane_count) - 1;

// Which lanes something holds for, a choice by it, the smaller and the larger, of which GCC makes a comparison and a
// choice unless it is told, and square roots.
#if defined(__AVX512F__)
using Choice = __mmask8;
inline Choice at_most(Lanes a, Lanes b) { return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LE_OQ); }
inline Lanes select(Choice c, Lanes a, Lanes b) { return (Lanes)_mm512_mask_blend_pd(c, (__m512d)b, (__m512d)a); }
inline unsigned bits(Choice c) { return c; }
inline Lanes min(Lanes a, Lanes b) { return (Lanes)_mm512_maskz_min_pd(all_bits, (__m512d)a, (__m512d)b); }
inline Lanes max(Lanes a, Lanes b) { return (Lanes)_mm512_maskz_max_pd(all_bits, (__m512d)a, (__m512d)b); }
inline Lanes sqrt(Lanes a) { return (Lanes)_mm512_maskz_sqrt_pd(all_bits, (__m512d)a); }
#else
using Choice = Mask;
inline Choice at_most(Lanes a, Lanes b) { return a <= b; }
inline Lanes select(Choice c, Lanes a, Lanes b) { return c ? a : b; }
#if defined(__AVX2__)
inline unsigned bits(Choice c) { return static_cast<unsigned>(_mm256_movemask_pd((__m256d)c)); }
inline Lanes min(Lanes a, Lanes b) { return (Lanes)_mm256_min_pd((__m256d)a, (__m256d)b); }
inline Lanes max(Lanes a, Lanes b) { return (Lanes)_mm256_max_pd((__m256d)a, (__m256d)b); }
inline Lanes sqrt(Lanes a) { return (Lanes)_mm256_sqrt_pd((__m256d)a); }
#elif defined(__SSE2__)
inline unsigned bits(Choice c) { return static_cast<unsigned>(_mm_movemask_pd((__m128d)c)); }
inline Lanes min(Lanes a, Lanes b) { return (Lanes)_mm_min_pd((__m128d)a, (__m128d)b); }
inline Lanes max(Lanes a, Lanes b) { return (Lanes)_mm_max_pd((__m128d)a, (__m128d)b); }
inline Lanes sqrt(Lanes a) { return (Lanes)_mm_sqrt_pd((__m128d)a); }
#else
inline unsigned bits(Choice c) { return static_cast<unsigned>((c[0] & 1) | (c[1] & 2)); }
inline Lanes min(Lanes a, Lanes b) { return a < b ? a : b; }
inline Lanes max(Lanes a, Lanes b) { return a > b ? a : b; }
inline Lanes sqrt(Lanes a) { return Lanes{__builtin_sqrt(a[0]), __builtin_sqrt(a[1])}; }
#endif
#endif

inline bool all_at_most(Lanes a, Lanes b) { return bits(at_most(a, b)) == all_bits; }
/// The first `number` lanes.
inline unsigned first_lanes(std::ptrdiff_t number) { return number < lane_count ? (1U << number) - 1 : all_bits; }
inline int count(unsigned lanes) {
  // Two lanes are those of processors that may have no instruction for it.
  return lane_count == 2 ? static_cast<int>((lanes & 1) + (lanes >> 1)) : __builtin_popcount(lanes);
}

}  // namespace ACSTUDY_ISA
}  // namespace acstudy
