# What every test program links. (A precompiled header for GoogleTest saves half
# a second per file, ten seconds in all on two cores, and defeats ccache and
# clang-tidy: not worth it.)
add_library(kith_testing INTERFACE)
target_link_libraries(kith_testing INTERFACE GTest::gmock_main)
target_include_directories(kith_testing INTERFACE ${PROJECT_SOURCE_DIR}/tests/support/include)
target_compile_definitions(kith_testing INTERFACE KITH_SOURCE_DIR="${PROJECT_SOURCE_DIR}")

# kith_test_program(<name> SOURCES a_test.cpp ... [DEPENDS lib ...])
#
# The program kith_<name>_tests; its tests appear in ctest as <name>.Suite.Test
# with the label <name>. Suites whose name contains "Slow" also have the label
# `slow`, which the normal run of the tests leaves out.
function(kith_test_program name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;DEPENDS")
  set(program kith_${name}_tests)
  add_executable(${program} ${arg_SOURCES})
  target_link_libraries(${program} PRIVATE kith_build kith_testing ${arg_DEPENDS})
  set(discovery TEST_PREFIX "${name}." DISCOVERY_MODE PRE_TEST)
  gtest_discover_tests(${program} ${discovery} TEST_LIST ${program}_quick TEST_FILTER "-*Slow*"
    PROPERTIES LABELS "${name}" TIMEOUT 120)
  gtest_discover_tests(${program} ${discovery} TEST_LIST ${program}_slow TEST_FILTER "*Slow*"
    PROPERTIES LABELS "${name}\\;slow" TIMEOUT 1800)
endfunction()
