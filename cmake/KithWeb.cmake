# kith_add_web_pages(<page>...)
#
# For every page, a folder of web/src, sets <page>_page to the path, in the build tree, of its
# template (one HTML file, see web/build.mjs) and defines the target kith_web_<page>, which makes it.
# Packages come from npm, once per build tree and whenever the lock file changes; the source tree
# stays as it is. Tests of the pages run where Chromium is installed.
find_program(KITH_NODE NAMES node nodejs DOC "Node.js, which bundles the pages")
find_program(KITH_NPM npm DOC "npm, which fetches what the pages are made of")
find_program(KITH_CHROMIUM NAMES chromium chromium-headless-shell DOC "Browser that tests the pages")
mark_as_advanced(KITH_NODE KITH_NPM KITH_CHROMIUM)

set(webcrypto --experimental-global-webcrypto)  # browsers have it, Debian's Node.js 18 on request only

# Of tests in a browser: one of files and one of pages that a server sends at a time, and first, because they take
# longest.
set(browser_of_files RESOURCE_LOCK browser_of_files COST 1000)
set(browser_of_pages RESOURCE_LOCK browser_of_pages COST 2000)

function(kith_add_web_pages)
  if(KITH_WEB STREQUAL AUTO AND NOT (KITH_NODE AND KITH_NPM))
    message(STATUS "No Node.js or npm: reports and lessons as pages are left out (apt-get install nodejs npm)")
  elseif(KITH_WEB AND NOT (KITH_NODE AND KITH_NPM))
    message(FATAL_ERROR "kith's pages are bundled with Node.js (18 or later) and npm, and one of them is missing. "
                        "On Debian: apt-get install nodejs npm; or build without pages: -DKITH_WEB=OFF")
  endif()
  if(NOT KITH_WEB OR NOT (KITH_NODE AND KITH_NPM))
    foreach(page IN LISTS ARGN)  # empty; the command line says that there is none
      set(${page}_page ${PROJECT_BINARY_DIR}/web/no_${page}.html PARENT_SCOPE)
      file(WRITE ${PROJECT_BINARY_DIR}/web/no_${page}.html "")
      add_custom_target(kith_web_${page})
    endforeach()
    return()
  endif()
  set(source ${PROJECT_SOURCE_DIR}/web)
  set(build ${PROJECT_BINARY_DIR}/web)
  set(stamp ${build}/node_modules/.kith-stamp)
  set(omit --omit=dev)  # the compiler of types, the browser's driver and axe: for tests only
  if(KITH_BUILD_TESTS)
    set(omit)
  endif()
  set(packages ${source}/package.json ${source}/package-lock.json ${source}/.npmrc)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${source}/src/*)

  add_custom_command(OUTPUT ${stamp}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${build}
    COMMAND ${CMAKE_COMMAND} -E copy ${packages} ${build}
    COMMAND ${KITH_NPM} ci --ignore-scripts --no-audit --no-fund --prefer-offline --loglevel=error ${omit}
    COMMAND ${CMAKE_COMMAND} -E touch ${stamp}
    DEPENDS ${packages} WORKING_DIRECTORY ${build}
    COMMENT "Fetching what the pages are made of (npm)" VERBATIM)
  add_custom_target(kith_web_packages DEPENDS ${stamp})
  foreach(page IN LISTS ARGN)
    set(file ${build}/${page}.html)
    add_custom_command(OUTPUT ${file}
      COMMAND ${KITH_NODE} ${source}/build.mjs --page ${page} --modules ${build} --out ${file}
      DEPENDS kith_web_packages ${stamp} ${source}/build.mjs ${source}/bundle.mjs ${source}/notices.mjs ${sources}
      COMMENT "Bundling the ${page} page" VERBATIM)
    add_custom_target(kith_web_${page} DEPENDS ${file})
    set(${page}_page ${file} PARENT_SCOPE)
  endforeach()
  if(KITH_BUILD_TESTS AND NOT KITH_SANITIZE)
    kith_test_web_pages(${source} ${build})
  endif()
endfunction()

function(kith_add_web_apps)
  set(source ${PROJECT_SOURCE_DIR}/web)
  set(build ${PROJECT_BINARY_DIR}/web)
  foreach(page IN LISTS ARGN)
    set(${page}_app ${build}/${page} PARENT_SCOPE)
    if(NOT TARGET kith_web_packages)
      file(WRITE ${build}/${page}/index.html "<!doctype html><title>kith</title><p>This kith was built without pages.</p>\n")
      add_custom_target(kith_web_${page})
      continue()
    endif()
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${source}/src/*)
    add_custom_command(OUTPUT ${build}/${page}/index.html
      COMMAND ${KITH_NODE} ${source}/build_app.mjs --page ${page} --modules ${build} --out ${build}/${page}
      DEPENDS kith_web_packages ${build}/node_modules/.kith-stamp ${source}/build_app.mjs ${source}/bundle.mjs ${source}/notices.mjs ${sources}
      COMMENT "Bundling the ${page} page" VERBATIM)
    add_custom_target(kith_web_${page} DEPENDS ${build}/${page}/index.html)
    if(KITH_BUILD_TESTS AND KITH_CHROMIUM AND NOT KITH_SANITIZE AND EXISTS ${source}/tests/${page}_test.mjs)
      string(SUBSTRING ${page} 0 1 first)
      string(TOUPPER ${first} first)
      string(SUBSTRING ${page} 1 -1 rest)
      set(name ${first}${rest})
      # People on the pages that the program serves.
      add_test(NAME web.${name} COMMAND ${KITH_NODE} ${webcrypto} ${source}/tests/${page}_test.mjs
        --kith $<TARGET_FILE:kith> --modules ${build} --chromium ${KITH_CHROMIUM})
      set_tests_properties(web.${name} PROPERTIES ${browser_of_pages} TIMEOUT 1200 LABELS web)
    endif()
  endforeach()
endfunction()

# Types, doors of lesson files, sample documents as a reader sees them, and documents that lack parts.
function(kith_test_web_pages source build)
  add_test(NAME web.Types COMMAND ${KITH_NODE} ${source}/tests/types_test.mjs --modules ${build})
  add_test(NAME web.DoorRules COMMAND ${KITH_NODE} ${webcrypto} ${source}/tests/door_rules_test.mjs --modules ${build})
  set_tests_properties(web.Types web.DoorRules PROPERTIES LABELS web)
  if(NOT KITH_CHROMIUM)
    message(STATUS "No Chromium: pages are not tested in a browser (apt-get install chromium)")
    return()
  endif()
  set(sample ${source}/sample/report.json)
  set(report ${build}/report.html)
  set(tools --modules ${build} --chromium ${KITH_CHROMIUM})
  add_test(NAME web.Report COMMAND ${KITH_NODE} ${source}/tests/report_test.mjs ${report} --document ${sample} ${tools})
  add_test(NAME web.ReportOfKith COMMAND ${KITH_NODE} ${source}/tests/report_test.mjs --kith $<TARGET_FILE:kith> ${tools})
  add_test(NAME web.ReportParts COMMAND ${KITH_NODE} ${source}/tests/parts_test.mjs ${report} ${sample} ${tools})
  add_test(NAME web.Lesson COMMAND ${KITH_NODE} ${source}/tests/lesson_test.mjs ${build}/lesson.html
    --kith $<TARGET_FILE:kith> ${tools})
  set_tests_properties(web.Report web.ReportOfKith web.ReportParts web.Lesson PROPERTIES
    ${browser_of_files} TIMEOUT 900 LABELS web)
  set_property(TEST web.ReportParts PROPERTY LABELS slow)
endfunction()

# kith_embed_web_apps(<target> <page>...)
#
# Makes the folders of pages (see kith_add_web_apps) constants in a source file of the target: see web/embed.mjs.
# Without Node.js there are no pages, and the table is empty.
function(kith_embed_web_apps target)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/web_assets.cpp)
  if(NOT TARGET kith_web_packages)
    file(CONFIGURE OUTPUT ${output} CONTENT "#include \"web_assets.hpp\"

namespace kith::cli {
std::span<const Asset> web_assets() { return {}; }
}  // namespace kith::cli
")
    target_sources(${target} PRIVATE ${output})
    set_source_files_properties(${output} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    return()
  endif()
  set(folders)
  set(pages)
  foreach(page IN LISTS ARGN)
    list(APPEND folders ${page}=${PROJECT_BINARY_DIR}/web/${page})
    list(APPEND pages kith_web_${page} ${PROJECT_BINARY_DIR}/web/${page}/index.html)
  endforeach()
  add_custom_command(OUTPUT ${output}
    COMMAND ${KITH_NODE} ${PROJECT_SOURCE_DIR}/web/embed.mjs --out ${output} ${folders}
    DEPENDS ${pages} ${PROJECT_SOURCE_DIR}/web/embed.mjs VERBATIM)
  target_sources(${target} PRIVATE ${output})
  set_source_files_properties(${output} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
