#pragma once

/// @file
/// Plain loops for the vectors that a processor has.

/// Compiles a function again for wider vectors; which is called is chosen when the program is loaded.
#if defined(__GLIBC__) && defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define ACSTUDY_VECTOR_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
/// The same for chains of products and sums, which take half as long where the two are one operation.
#define ACSTUDY_CHAIN_CLONES __attribute__((target_clones("fma", "default")))
#else
#define ACSTUDY_VECTOR_CLONES
#define ACSTUDY_CHAIN_CLONES
#endif
