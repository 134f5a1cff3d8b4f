# Headers of the standard library and of dependencies, precompiled, for builds
# from scratch: they are half of what there is to compile. Off by default,
# because ccache and clang-tidy do not get on with it; run.sh and test.sh turn
# it on. No file may rely on it: the headers alone (all_verify_interface_header_sets)
# and ordinary builds include what they use.
option(KITH_PRECOMPILE "Precompile the headers of dependencies, to build faster from scratch" OFF)

# kith_precompiled_headers(<name> DEPENDS lib ... HEADERS header ...): a set of them. One is made per set, and
# shared by the targets that are compiled in the same way.
function(kith_precompiled_headers name)
  if(NOT KITH_PRECOMPILE)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 arg "EXECUTABLE" "" "DEPENDS;HEADERS")
  set(source ${PROJECT_BINARY_DIR}/${name}.cpp)
  if(arg_EXECUTABLE)
    file(CONFIGURE OUTPUT ${source} CONTENT "int main() {}\n")
    add_executable(${name} ${source})
  else()
    file(CONFIGURE OUTPUT ${source} CONTENT "static_assert(true);\n")
    add_library(${name} STATIC ${source})
  endif()
  target_compile_features(${name} PRIVATE cxx_std_20)
  target_link_libraries(${name} PRIVATE $<BUILD_INTERFACE:kith_build> ${arg_DEPENDS})
  target_precompile_headers(${name} PRIVATE ${arg_HEADERS})
  set_target_properties(${name} PROPERTIES KITH_DEPENDS "${arg_DEPENDS}")
endfunction()

# kith_use_precompiled_headers(<target> <set>). The compiler wants the macros of all dependencies of the set to be
# defined, also for a target that does not depend on them. Files with compile options of their own need
# SKIP_PRECOMPILE_HEADERS.
function(kith_use_precompiled_headers target name)
  if(NOT KITH_PRECOMPILE)
    return()
  endif()
  target_precompile_headers(${target} REUSE_FROM ${name})
  # Of precompiled text g++ 12 forgets that it is the library's own, and warns of its inlined copies; ordinary builds
  # keep both warnings.
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-stringop-overflow -Wno-array-bounds)
  endif()
  get_target_property(depends ${name} KITH_DEPENDS)
  foreach(dependency IN LISTS depends)
    target_compile_definitions(${target} PRIVATE $<TARGET_PROPERTY:${dependency},INTERFACE_COMPILE_DEFINITIONS>)
  endforeach()
endfunction()

set(standard_headers
  <algorithm> <array> <charconv> <cmath> <cstdint> <filesystem> <fstream> <functional> <map> <memory> <numeric>
  <optional> <set> <span> <sstream> <stdexcept> <string> <string_view> <unordered_map> <utility> <vector>)
