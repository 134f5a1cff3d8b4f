# Everything kith needs from outside, all of it packaged in Debian 12; why each
# was chosen: docs/adr/0008-dependencies.md. `./run.sh --setup` installs them.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB REQUIRED)
find_package(Boost 1.74 REQUIRED) # headers only: Boost.Math
find_package(nlohmann_json REQUIRED)
find_package(fmt REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(Threads REQUIRED)
if(KITH_BUILD_APPS)
  find_package(CLI11 REQUIRED)
endif()
if(KITH_BUILD_TESTS)
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()
if(KITH_BUILD_BENCHMARKS)
  find_package(benchmark REQUIRED)
endif()

# Header-only or without a CMake package of their own: say early, and by the
# name of the package, what a compiler would only say as "no such file".
foreach(header_and_package "Random123/philox.h|librandom123-dev" "toml++/toml.h|libtomlplusplus-dev" "csv.h|libcsv-dev"
    "boost/math/distributions/fisher_f.hpp|libboost-math-dev")
  string(REPLACE "|" ";" header_and_package ${header_and_package})
  list(GET header_and_package 0 header)
  list(GET header_and_package 1 package)
  string(MAKE_C_IDENTIFIER KITH_${package}_FOLDER folder)
  find_path(${folder} ${header})
  mark_as_advanced(${folder})
  if(NOT ${folder})
    message(FATAL_ERROR "kith needs <${header}>: apt-get install ${package}")
  endif()
endforeach()
