#pragma once

#include <Eigen/Core>

// Eigen objects are passed between kith's libraries and the programs that link them. By default their layout, their
// allocation and the order of their sums, and so the bits of these, depend on the instruction set (-march) that a file
// is compiled for. kith's CMake targets fix all three with these definitions, so that a program may be compiled for
// another instruction set than the libraries.
#if EIGEN_DEFAULT_ALIGN_BYTES != 64 || EIGEN_MAX_STATIC_ALIGN_BYTES != 16 || !defined(EIGEN_DONT_VECTORIZE)
#error "compile with -DEIGEN_MAX_ALIGN_BYTES=64 -DEIGEN_MAX_STATIC_ALIGN_BYTES=16 -DEIGEN_DONT_VECTORIZE, as kith was"
#endif
