#pragma once

#include <Eigen/Core>

// Eigen objects are passed between kith's libraries and the programs that link them. By default their layout and their
// allocation depend on the instruction set (-march) that a file is compiled for. kith's CMake targets fix both with two
// definitions, so that a program may be compiled for another instruction set than the libraries.
#if EIGEN_DEFAULT_ALIGN_BYTES != 64 || EIGEN_MAX_STATIC_ALIGN_BYTES != 16
#error "compile with -DEIGEN_MAX_ALIGN_BYTES=64 -DEIGEN_MAX_STATIC_ALIGN_BYTES=16, as kith was; its targets do"
#endif
