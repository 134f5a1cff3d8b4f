# What every test program links.
add_library(kith_testing INTERFACE)
target_link_libraries(kith_testing INTERFACE GTest::gmock_main kith_compiled_fast)
target_include_directories(kith_testing INTERFACE ${PROJECT_SOURCE_DIR}/tests/support/include)
target_compile_definitions(kith_testing INTERFACE KITH_SOURCE_DIR="${PROJECT_SOURCE_DIR}")

# Of an inline function that several objects hold, the linker takes the first: that of a library, which is compiled to
# be fast, has to come before that of a test, which is compiled fast. Linked once more behind them, a library adds nothing.
function(kith_link_fast_first program)
  if(KITH_SANITIZE OR NOT CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
    return()
  endif()
  set(waiting ${ARGN})
  set(seen)
  while(waiting)
    list(POP_FRONT waiting library)
    string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" library "${library}")
    if(library MATCHES "^kith::" AND NOT library IN_LIST seen)
      list(APPEND seen ${library})
      get_target_property(needed ${library} INTERFACE_LINK_LIBRARIES)
      list(APPEND waiting ${needed})
    endif()
  endwhile()
  list(TRANSFORM seen REPLACE "(.+)" "$<$<STREQUAL:$<TARGET_PROPERTY:\\1,TYPE>,STATIC_LIBRARY>:$<TARGET_FILE:\\1>>")
  target_link_options(${program} PRIVATE LINKER:--whole-archive ${seen} LINKER:--no-whole-archive)
endfunction()

# The tests (NAME_test.cpp) that ThreadSanitizer is to see of programs that mostly use one thread.
set(kith_threaded_mdp policy_partition)
set(kith_threaded_bec behaviours)
set(kith_threaded_teaching session_events)
set(kith_threaded_study any_domain run)
set(kith_threaded_runs study_run merge ranks)

# Programs that take long, and the number of processes that share their tests where a program is not split by test.
set(kith_processes_cli 6)
set(kith_processes_service 3)
# Those that begin first where no run has measured any, in seconds.
set(kith_cost_service 100)
set(kith_cost_cli 80)
set(kith_cost_laws 50)
set(kith_cost_live 40)
set(kith_cost_explain 30)
set(kith_cost_bec 20)

# kith_test_program(<name> SOURCES a_test.cpp ... [DEPENDS lib ...])
#
# The program kith_<name>_tests. Where files are compiled many at a time (the presets release, asan and tsan) it is one
# test, <name>, or a few that share its tests: starting it anew for each of its tests, which then make the same atlas
# again, takes longer than the tests. Elsewhere every test of it is a test of ctest: <name>.Suite.Test. The label is
# <name>. Suites whose name contains "Slow" have the label `slow` instead, which the normal run of the tests leaves out.
function(kith_test_program name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;DEPENDS")
  set(program kith_${name}_tests)
  if(KITH_SANITIZE STREQUAL thread AND DEFINED kith_threaded_${name})
    list(JOIN kith_threaded_${name} "|" threaded)
    list(FILTER arg_SOURCES INCLUDE REGEX "/(${threaded})_test\\.cpp$")
  endif()
  add_executable(${program} ${arg_SOURCES})
  target_link_libraries(${program} PRIVATE kith_build kith_testing ${arg_DEPENDS})
  kith_link_fast_first(${program} ${arg_DEPENDS})
  set(slow_suites "*Slow*.*")
  if(KITH_SANITIZE)
    # Seconds otherwise, minutes here; what they call is also called by quick tests.
    string(APPEND slow_suites ":Recovery.*:SolidAngleInDimensions.IsAdditive*:SolidAngleInDimensions.AgreesWithCounting*"
           ":ConeSampler.CoversMore*:ConeSampler.DrawsUniformly*:RandomEndlessPaths.*:WholePaths.LeaveHardlyAny*"
           ":*EndlessPaths.*/rescue*:*EndlessPaths.*/warehouse:EndlessRobot.AreSaidToMiss*:*EndlessRobots.*/co*"
           ":*EndlessRobots.*/item*:Told.*:JudgedPeople.*:AnyDomain.DiscountedOnes*:TeamExam.ConfirmsTheStopRule*")
  endif()
  set(quick "-${slow_suites}")
  set(discovery TEST_PREFIX "${name}." DISCOVERY_MODE PRE_TEST NO_PRETTY_VALUES)
  if(KITH_SANITIZE)
    add_test(NAME ${name}.slow COMMAND ${program} --gtest_brief=1 --gtest_filter=${slow_suites})
    set_tests_properties(${name}.slow PROPERTIES LABELS slow TIMEOUT 7200)
  else()
    gtest_discover_tests(${program} ${discovery} TEST_LIST ${program}_slow TEST_FILTER "${slow_suites}"
      PROPERTIES LABELS slow TIMEOUT 1800)
  endif()
  if(NOT CMAKE_UNITY_BUILD)
    gtest_discover_tests(${program} ${discovery} TEST_LIST ${program}_quick TEST_FILTER "${quick}"
      PROPERTIES LABELS ${name} TIMEOUT 120)
    return()
  endif()
  set(processes 1)
  if(DEFINED kith_processes_${name})
    set(processes ${kith_processes_${name}})
  endif()
  foreach(process RANGE 1 ${processes})
    set(test ${name})
    if(processes GREATER 1)
      string(APPEND test .${process})
    endif()
    math(EXPR shard "${process} - 1")
    add_test(NAME ${test} COMMAND ${program} --gtest_brief=1 --gtest_filter=${quick})
    set_tests_properties(${test} PROPERTIES LABELS ${name} TIMEOUT 1200 COST "${kith_cost_${name}}"
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${processes};GTEST_SHARD_INDEX=${shard}")
  endforeach()
endfunction()
