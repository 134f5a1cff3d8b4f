# What every test program links.
add_library(kith_testing INTERFACE)
target_link_libraries(kith_testing INTERFACE GTest::gmock_main)
target_include_directories(kith_testing INTERFACE ${PROJECT_SOURCE_DIR}/tests/support/include)
# Tests need not be fast, but have to be compiled, which takes two thirds of the time without optimisation.
target_compile_options(kith_testing INTERFACE "$<$<CONFIG:Release>:-O0;-U_FORTIFY_SOURCE>")
target_compile_definitions(kith_testing INTERFACE KITH_SOURCE_DIR="${PROJECT_SOURCE_DIR}")

# What ThreadSanitizer is to see of programs that mostly use one thread.
set(kith_threaded_mdp "PolicyPartition.*:PolicyLookup.*:PartitionStore.*")
set(kith_threaded_bec "Behaviours.*")
set(kith_threaded_teaching "SessionEvents.ThreadsShareAnAtlasAndHandCachesOn:SessionEvents.NeitherCacheNorThreadMatters")
set(kith_threaded_study "AnyDomain.*:RunTeams.*:Teams.*")
set(kith_threaded_runs "StudyRunTest.*:ShardTest.*")

# kith_test_program(<name> SOURCES a_test.cpp ... [DEPENDS lib ...])
#
# The program kith_<name>_tests; its tests appear in ctest as <name>.Suite.Test
# with the label <name>. Suites whose name contains "Slow" have the label `slow`
# instead, which the normal run of the tests leaves out. Under sanitizers a
# program is one test: starting it anew for each of its tests, which then make
# the same atlas again, took longer than the tests.
function(kith_test_program name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;DEPENDS")
  set(program kith_${name}_tests)
  add_executable(${program} ${arg_SOURCES})
  target_link_libraries(${program} PRIVATE kith_build kith_testing ${arg_DEPENDS})
  set(slow_suites "*Slow*.*")
  if(KITH_SANITIZE)
    # Seconds otherwise, minutes here; what they call is also called by quick tests.
    string(APPEND slow_suites ":Recovery.*:SolidAngleInDimensions.IsAdditive*:SolidAngleInDimensions.AgreesWithCounting*"
           ":ConeSampler.CoversMore*:ConeSampler.DrawsUniformly*")
    set(quick "-${slow_suites}")
    if(KITH_SANITIZE STREQUAL thread AND DEFINED kith_threaded_${name})
      set(quick "${kith_threaded_${name}}-${slow_suites}")
    endif()
    add_test(NAME ${name} COMMAND ${program} --gtest_brief=1 --gtest_filter=${quick})
    add_test(NAME ${name}.slow COMMAND ${program} --gtest_brief=1 --gtest_filter=${slow_suites})
    set_tests_properties(${name} PROPERTIES LABELS ${name} TIMEOUT 1200)
    set_tests_properties(${name}.slow PROPERTIES LABELS slow TIMEOUT 7200)
    return()
  endif()
  set(discovery TEST_PREFIX "${name}." DISCOVERY_MODE PRE_TEST NO_PRETTY_VALUES)
  gtest_discover_tests(${program} ${discovery} TEST_LIST ${program}_quick TEST_FILTER "-${slow_suites}"
    PROPERTIES LABELS ${name} TIMEOUT 120)
  gtest_discover_tests(${program} ${discovery} TEST_LIST ${program}_slow TEST_FILTER "${slow_suites}"
    PROPERTIES LABELS slow TIMEOUT 1800)
endfunction()
