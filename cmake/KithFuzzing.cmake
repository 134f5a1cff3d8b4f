# kith_fuzz_target(<name> [MAX_LEN bytes] [DICTIONARY name] [LEAKS_AT_END] [DEPENDS lib ...])
#
# The target tests/fuzz/targets/<name>.cpp, a function of any bytes, as
#
#   fuzz_replay_<name>  the test fuzz.<name>: every file of its corpus, any compiler
#   fuzz_<name>         with libFuzzer, if KITH_BUILD_FUZZERS (needs clang, and
#                       the sanitizers that the preset `fuzz` sets)
#
# MAX_LEN and DICTIONARY are what tests/fuzz/run.sh starts libFuzzer with; with
# LEAKS_AT_END it looks for leaks when the program ends only, not after every
# input that leaves something allocated, such as a database that keeps memory.
if(KITH_BUILD_FUZZERS AND NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  message(FATAL_ERROR "KITH_BUILD_FUZZERS needs clang: cmake --preset fuzz")
endif()

if(KITH_BUILD_FUZZERS)
  add_custom_target(kith_fuzzers)  # all of them, and no layer that none of them needs
endif()

function(kith_fuzz_target name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "LEAKS_AT_END" "MAX_LEN;DICTIONARY" "DEPENDS")
  set(folder ${PROJECT_SOURCE_DIR}/tests/fuzz)
  if(KITH_BUILD_TESTS)
    add_executable(fuzz_replay_${name} targets/${name}.cpp)
    target_link_libraries(fuzz_replay_${name} PRIVATE
      kith_build kith_compiled_fast kith_fuzzing kith_fuzz_replay ${arg_DEPENDS})
    kith_link_fast_first(fuzz_replay_${name} ${arg_DEPENDS})
    add_test(NAME fuzz.${name} COMMAND fuzz_replay_${name} ${folder}/corpus/${name})
    set_tests_properties(fuzz.${name} PROPERTIES LABELS fuzz TIMEOUT 120)
  endif()
  if(KITH_BUILD_FUZZERS)
    add_executable(fuzz_${name} targets/${name}.cpp libfuzzer.cpp)
    set_target_properties(fuzz_${name} PROPERTIES UNITY_BUILD OFF)
    target_link_libraries(fuzz_${name} PRIVATE kith_build kith_fuzzing ${arg_DEPENDS})
    target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer -fprofile-instr-generate=/dev/null)
    add_dependencies(kith_fuzzers fuzz_${name})
    set(options "max_len=${arg_MAX_LEN}")
    if(arg_DICTIONARY)
      string(APPEND options " dict=${folder}/dictionaries/${arg_DICTIONARY}.dict")
    endif()
    if(arg_LEAKS_AT_END)
      string(APPEND options " detect_leaks=0")
    endif()
    file(WRITE ${PROJECT_BINARY_DIR}/fuzz/${name}.options "${options}\n")
  endif()
endfunction()
