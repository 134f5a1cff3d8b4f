# The documentation as a site that works offline, with search: target kith_site, build/PRESET/site/docs/README.html.
find_program(KITH_SPHINX sphinx-build REQUIRED DOC "Sphinx with MyST (python3-sphinx, python3-myst-parser)")
file(GLOB_RECURSE pages CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/docs/*.md ${PROJECT_SOURCE_DIR}/docs/site/*)
set(site ${PROJECT_BINARY_DIR}/site)
add_custom_command(OUTPUT ${site}/searchindex.js
  COMMAND ${KITH_SPHINX} -q -W --keep-going -E -b html -d ${PROJECT_BINARY_DIR}/site-cache -c ${PROJECT_SOURCE_DIR}/docs/site
    ${PROJECT_SOURCE_DIR} ${site}
  DEPENDS ${pages} ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CONTRIBUTING.md
    ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_SOURCE_DIR}/THIRD_PARTY.md
  COMMENT "Writing the documentation site" VERBATIM)
add_custom_target(kith_site ALL DEPENDS ${site}/searchindex.js)
if(KITH_INSTALL)
  install(DIRECTORY ${site}/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/html COMPONENT program
    PATTERN objects.inv EXCLUDE PATTERN .buildinfo EXCLUDE)
endif()
