# `cmake --install`, find_package(kith) and `cpack`; tested by tests/install.
include(CMakePackageConfigHelpers)
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # packages are made of what was built, without tests
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/kith)

# A layer is a component of the package: find_package(kith COMPONENTS geometry) looks for what geometry needs only.
install(TARGETS kith_eigen EXPORT kith-eigen COMPONENT development)
install(EXPORT kith-eigen NAMESPACE kith:: DESTINATION ${package_dir} COMPONENT development)
get_property(KITH_LAYERS GLOBAL PROPERTY KITH_LAYERS)
set(KITH_LAYER_NEEDS)
foreach(layer IN LISTS KITH_LAYERS)
  get_property(needs GLOBAL PROPERTY KITH_NEEDS_${layer})
  list(JOIN needs " " needs)
  string(APPEND KITH_LAYER_NEEDS "set(_kith_needs_${layer} ${needs})\n")
endforeach()
list(JOIN KITH_LAYERS " " KITH_LAYERS)
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/kithConfig.cmake.in ${PROJECT_BINARY_DIR}/kithConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(
  ${PROJECT_BINARY_DIR}/kithConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/kithConfig.cmake ${PROJECT_BINARY_DIR}/kithConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindLibqrencode.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindLibyaml.cmake DESTINATION ${package_dir} COMPONENT development)

if(TARGET kith)
  install(TARGETS kith COMPONENT program)
  if(TARGET kith_mpi)
    install(TARGETS kith_mpi DESTINATION ${CMAKE_INSTALL_LIBDIR}/kith COMPONENT mpi)
  endif()
  set(manual ${PROJECT_BINARY_DIR}/manual)
  add_custom_command(OUTPUT ${manual}/kith.1
    COMMAND ${CMAKE_COMMAND} -D KITH=$<TARGET_FILE:kith> -D OUTPUT_DIR=${manual}
      -P ${PROJECT_SOURCE_DIR}/cmake/WriteManual.cmake
    DEPENDS kith ${PROJECT_SOURCE_DIR}/cmake/WriteManual.cmake COMMENT "Writing the manual" VERBATIM)
  add_custom_target(kith_manual ALL DEPENDS ${manual}/kith.1)
  install(DIRECTORY ${manual}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program FILES_MATCHING PATTERN "*.1")
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/domains ${PROJECT_SOURCE_DIR}/studies
  DESTINATION ${CMAKE_INSTALL_DATADIR}/kith COMPONENT program FILES_MATCHING PATTERN "*.toml" PATTERN "*.csv"
  PATTERN "*.pgm" PATTERN "*.yaml")
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/THIRD_PARTY.md
  DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "kith developers <kith@localhost>")
set(CPACK_PACKAGE_VENDOR kith)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME kith)
# For kith analyze --model.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS
  "r-base-core, r-cran-lme4, r-cran-lmertest, r-cran-emmeans, r-cran-car, r-cran-mass, r-cran-ordinal, r-cran-survival, r-cran-jsonlite")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libkith-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libeigen3-dev, libfmt-dev, nlohmann-json3-dev, libssl-dev, libsqlite3-dev, libqrencode-dev, libyaml-dev")
set(CPACK_COMPONENTS_ALL program development)
if(TARGET kith_mpi)  # it alone needs MPI, which brings 30 packages
  list(APPEND CPACK_COMPONENTS_ALL mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_NAME kith-mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "kith (= ${PROJECT_VERSION})")
  set(CPACK_DEBIAN_MPI_PACKAGE_RECOMMENDS openmpi-bin)
  set(CPACK_COMPONENT_MPI_DESCRIPTION "Studies of kith on several machines by MPI")
endif()
if(KITH_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-kith)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  math(EXPR next "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= ${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}), python3 (<< ${Python3_VERSION_MAJOR}.${next})")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "python3-numpy, python3-pandas")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "The module kith for Python")
endif()
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "The program kith, its manual and documentation")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Libraries and headers, for programs of one's own")
include(CPack)
