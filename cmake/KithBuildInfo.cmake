# kith_build_info: link it PRIVATE to include "kith_build_info.hpp", which says
# what this build is (version, git commit, compiler, flags). The commit is looked
# up at every build, and the header changes only if the commit does.
set(KITH_GENERATED_DIR ${PROJECT_BINARY_DIR}/generated)
string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
string(STRIP "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}}" KITH_FLAGS)
if(KITH_SANITIZE)
  string(APPEND KITH_FLAGS " -fsanitize=${KITH_SANITIZE}")
endif()

add_custom_target(kith_write_build_info
  COMMAND ${CMAKE_COMMAND}
    -D SOURCE_DIR=${PROJECT_SOURCE_DIR} -D OUTPUT=${KITH_GENERATED_DIR}/kith_build_info.hpp
    -D VERSION=${PROJECT_VERSION} "-DCOMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}"
    "-DFLAGS=${KITH_FLAGS}" "-DBUILD_TYPE=${CMAKE_BUILD_TYPE}"
    -P ${PROJECT_SOURCE_DIR}/cmake/WriteBuildInfo.cmake
  BYPRODUCTS ${KITH_GENERATED_DIR}/kith_build_info.hpp
  COMMENT "" VERBATIM)
add_library(kith_build_info INTERFACE)
add_dependencies(kith_build_info kith_write_build_info)
target_include_directories(kith_build_info INTERFACE $<BUILD_INTERFACE:${KITH_GENERATED_DIR}>)
