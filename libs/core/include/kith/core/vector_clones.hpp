#pragma once

#include <cstddef>  // defines __GLIBC__, where that is the C library

/// Before the definition of a function whose plain loops the compiler
/// vectorises: compiles it for the baseline instruction set, for AVX2 and for x86-64-v4 (AVX-512),
/// and lets the loader choose once per process what the machine can do (GNU
/// indirect functions). All do the same operations on the same numbers in the
/// same order, without fused multiply-add: the results are the same bits.
/// Nothing on other processors, compilers and C libraries, or with sanitizers,
/// which are not ready when the loader chooses.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && defined(__GLIBC__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !defined(KITH_NO_VECTOR_CLONES)
#define KITH_VECTOR_CLONES __attribute__((target_clones("default", "avx2", "arch=x86-64-v4")))
#else
#define KITH_VECTOR_CLONES
#endif

/// Before a loop whose iterations do not depend on one another, although the
/// compiler cannot see that its arrays do not overlap.
#if defined(__GNUC__) && !defined(__clang__)
#define KITH_INDEPENDENT_LOOP _Pragma("GCC ivdep")
#else
#define KITH_INDEPENDENT_LOOP
#endif
