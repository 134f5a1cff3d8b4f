# The documentation as a site that works offline, with search: target kith_site, build/PRESET/site/docs/README.html.
# Doxygen adds a reference of the public headers, site/api/index.html; the program a page for every command.
find_program(KITH_SPHINX sphinx-build REQUIRED DOC "Sphinx with MyST (python3-sphinx, python3-myst-parser)")
find_program(KITH_DOXYGEN doxygen DOC "Doxygen, for the reference of the libraries")
file(GLOB_RECURSE pages CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/docs/*.md ${PROJECT_SOURCE_DIR}/docs/site/*)
set(site ${PROJECT_BINARY_DIR}/site)
set(reference)
set(tags)
if(KITH_DOXYGEN)
  file(GLOB header_folders ${PROJECT_SOURCE_DIR}/libs/*/include)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/libs/*/include/*.hpp)
  list(TRANSFORM header_folders REPLACE "(.+)" "\"\\1\"")
  list(JOIN header_folders " " header_folders)
  configure_file(${PROJECT_SOURCE_DIR}/docs/site/Doxyfile.in ${PROJECT_BINARY_DIR}/Doxyfile @ONLY)
  list(APPEND reference ${site}/api/index.html)
  list(APPEND tags -t api)
  add_custom_command(OUTPUT ${site}/api/index.html
    COMMAND ${CMAKE_COMMAND} -E make_directory ${site} COMMAND ${KITH_DOXYGEN} ${PROJECT_BINARY_DIR}/Doxyfile
    DEPENDS ${headers} ${PROJECT_BINARY_DIR}/Doxyfile COMMENT "Writing the reference of the libraries" VERBATIM)
endif()
if(TARGET kith)
  list(APPEND reference ${site}/commands/index.html)
  list(APPEND tags -t commands)
  add_custom_command(OUTPUT ${site}/commands/index.html
    COMMAND ${CMAKE_COMMAND} -D KITH=$<TARGET_FILE:kith> -D OUTPUT_DIR=${PROJECT_BINARY_DIR}/site-manual
      -D HTML_DIR=${site}/commands -P ${PROJECT_SOURCE_DIR}/cmake/WriteManual.cmake
    DEPENDS kith ${PROJECT_SOURCE_DIR}/cmake/WriteManual.cmake COMMENT "Writing a page for every command" VERBATIM)
endif()
add_custom_command(OUTPUT ${site}/searchindex.js
  COMMAND ${KITH_SPHINX} -q -W --keep-going -E -b html ${tags} -d ${PROJECT_BINARY_DIR}/site-cache
    -c ${PROJECT_SOURCE_DIR}/docs/site ${PROJECT_SOURCE_DIR} ${site}
  DEPENDS ${pages} ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CONTRIBUTING.md
    ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/THIRD_PARTY.md
  COMMENT "Writing the documentation site" VERBATIM)
add_custom_target(kith_site ALL DEPENDS ${site}/searchindex.js ${reference})
if(KITH_INSTALL)
  install(DIRECTORY ${site}/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/html COMPONENT program
    PATTERN objects.inv EXCLUDE PATTERN .buildinfo EXCLUDE)
endif()
