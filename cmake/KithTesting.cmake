# What every test program links: GoogleTest with its matchers, precompiled once.
find_package(GTest REQUIRED)
add_library(kith_testing INTERFACE)
target_link_libraries(kith_testing INTERFACE GTest::gmock_main)
target_include_directories(kith_testing INTERFACE ${PROJECT_SOURCE_DIR}/tests/support/include)
target_compile_definitions(kith_testing INTERFACE KITH_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
