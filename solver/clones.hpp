#pragma once

/// @file
/// Plain loops for the vectors that a processor has.

/// Compiles a function again for wider vectors; which is called is chosen when the program is loaded.
#if defined(__GLIBC__) && defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define ACSTUDY_VECTOR_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define ACSTUDY_VECTOR_CLONES
#endif
