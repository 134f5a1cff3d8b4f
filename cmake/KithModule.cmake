# kith_module(<name> [DEPENDS kith::x ...] [PRIVATE_DEPENDS lib ...] [TEST_DEPENDS lib ...])
#
# One folder under libs/ = one target = one layer = one include root. DEPENDS is
# the only way to see another layer's headers, so the graph in CMake is the
# graph in the code. Sources (src/*.cpp), headers (include/kith/<name>/*.hpp)
# and tests (tests/*_test.cpp) are found by their place; a layer without sources
# is header-only.
#
# Every header is compiled alone against exactly DEPENDS by the target
# all_verify_interface_header_sets, which is not part of `all`.
function(kith_module name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "DEPENDS;PRIVATE_DEPENDS;TEST_DEPENDS")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "kith_module(${name}): what is '${arg_UNPARSED_ARGUMENTS}'?")
  endif()
  file(GLOB headers CONFIGURE_DEPENDS include/kith/${name}/*.hpp)
  file(GLOB sources CONFIGURE_DEPENDS src/*.cpp)

  if(sources)
    set(kind PUBLIC)
    add_library(kith_${name} STATIC ${sources})
    target_link_libraries(kith_${name} PRIVATE $<BUILD_INTERFACE:kith_build> ${arg_PRIVATE_DEPENDS})
    target_include_directories(kith_${name} PRIVATE src)
  else()
    set(kind INTERFACE)
    add_library(kith_${name} INTERFACE)
  endif()
  add_library(kith::${name} ALIAS kith_${name})
  set_target_properties(kith_${name} PROPERTIES EXPORT_NAME ${name} VERIFY_INTERFACE_HEADER_SETS ON)
  target_sources(kith_${name} ${kind} FILE_SET HEADERS BASE_DIRS include FILES ${headers})
  target_compile_features(kith_${name} ${kind} cxx_std_20)
  target_link_libraries(kith_${name} ${kind} ${arg_DEPENDS})
  if(KITH_INSTALL)
    install(TARGETS kith_${name} EXPORT kith-${name} COMPONENT development FILE_SET HEADERS COMPONENT development)
    install(EXPORT kith-${name} NAMESPACE kith:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/kith COMPONENT development)
    set(needs ${arg_DEPENDS} ${arg_PRIVATE_DEPENDS})
    list(FILTER needs EXCLUDE REGEX BUILD_INTERFACE)
    set_property(GLOBAL APPEND PROPERTY KITH_LAYERS ${name})
    set_property(GLOBAL PROPERTY KITH_NEEDS_${name} ${needs})
  endif()

  file(GLOB tests CONFIGURE_DEPENDS tests/*_test.cpp)
  if(KITH_BUILD_TESTS AND tests)
    kith_test_program(${name} SOURCES ${tests} DEPENDS kith::${name} ${arg_TEST_DEPENDS})
    target_include_directories(kith_${name}_tests PRIVATE tests)
  endif()
endfunction()
