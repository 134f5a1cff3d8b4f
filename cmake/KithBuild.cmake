# How every translation unit of kith is compiled. Linked PRIVATE, so none of it
# reaches users of the libraries.
#
# The bits of a result are part of the result, so what could change them is
# fixed here: the baseline instruction set (x86-64-v2; faster kernels are chosen
# at run time), no contraction to fused multiply-add, no fast-math.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES AND PROJECT_IS_TOP_LEVEL)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Kind of build" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)

if(KITH_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  find_program(KITH_CCACHE_PROGRAM ccache)
  mark_as_advanced(KITH_CCACHE_PROGRAM)
  if(KITH_CCACHE_PROGRAM)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${KITH_CCACHE_PROGRAM})
  endif()
endif()

# A library that is compiled as one file takes up to 2.2 GB: at most as many compilers at once as fit into memory.
if(PROJECT_IS_TOP_LEVEL AND CMAKE_UNITY_BUILD AND NOT CMAKE_JOB_POOL_COMPILE)
  cmake_host_system_information(RESULT memory_mib QUERY TOTAL_PHYSICAL_MEMORY)
  math(EXPR compilers "${memory_mib} / 2300")
  if(compilers LESS 1)
    set(compilers 1)
  endif()
  set_property(GLOBAL APPEND PROPERTY JOB_POOLS kith_compilers=${compilers})
  set(CMAKE_JOB_POOL_COMPILE kith_compilers)
endif()

add_library(kith_build INTERFACE)
target_compile_options(kith_build INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor -Wold-style-cast
  -Woverloaded-virtual -Wdouble-promotion -Wimplicit-fallthrough -Wformat=2 -Wcast-qual -Wundef
  $<$<BOOL:${KITH_WERROR}>:-Werror>
  -ffp-contract=off -fno-fast-math
  -fno-semantic-interposition)  # position-independent, and still inlined within a file
target_compile_definitions(kith_build INTERFACE _GLIBCXX_ASSERTIONS)
# g++ 12 sees overlapping copies in "literal" + std::string (GCC bug 105651, mended in 13). And GCC thinks of vectors
# without entries that Eigen's loops would read, and of members of a variant.
target_compile_options(kith_build INTERFACE
  $<$<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_LESS:$<CXX_COMPILER_VERSION>,13>>:-Wno-restrict>
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
  target_compile_options(kith_build INTERFACE -march=x86-64-v2)
endif()

if(KITH_SANITIZE)
  target_compile_options(kith_build INTERFACE
    -fsanitize=${KITH_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(kith_build INTERFACE -fsanitize=${KITH_SANITIZE})
else()
  # _FORTIFY_SOURCE needs an optimiser.
  target_compile_options(kith_build INTERFACE
    -fstack-protector-strong "$<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=2>")
  target_link_options(kith_build INTERFACE LINKER:-z,relro,-z,now)
endif()

# What tests need only, linked after kith_build: it need not be fast, but has to be compiled, which takes two thirds of
# the time without optimisation.
add_library(kith_compiled_fast INTERFACE)
target_compile_options(kith_compiled_fast INTERFACE "$<$<CONFIG:Release>:-O0;-U_FORTIFY_SOURCE>")

# Eigen with one layout, one way of allocating and one order of adding whatever -march is, in kith and in every program
# that links it (see kith/geometry/eigen.hpp).
add_library(kith_eigen INTERFACE)
set_target_properties(kith_eigen PROPERTIES EXPORT_NAME eigen)
target_link_libraries(kith_eigen INTERFACE Eigen3::Eigen)
target_compile_definitions(kith_eigen INTERFACE
  EIGEN_MAX_ALIGN_BYTES=64 EIGEN_MAX_STATIC_ALIGN_BYTES=16 EIGEN_DONT_VECTORIZE)
