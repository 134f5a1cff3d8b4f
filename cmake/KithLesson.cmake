# Sets lesson_file_page to the template of lesson files (`kith lesson`): a page with the libraries as WebAssembly in it,
# made with Emscripten if KITH_LESSON is ON. Otherwise the file is empty, and the command says how to get it.
set(lesson_file_page ${PROJECT_BINARY_DIR}/web/no_lesson_file.html)
if(NOT KITH_LESSON)
  file(WRITE ${lesson_file_page} "")
  return()
endif()
find_program(KITH_EMXX em++ REQUIRED DOC "Emscripten, which compiles the engine of lesson files")
find_file(KITH_EMSCRIPTEN_TOOLCHAIN Emscripten.cmake REQUIRED
  PATHS /usr/share/emscripten/cmake/Modules/Platform $ENV{EMSDK}/upstream/emscripten/cmake/Modules/Platform)
mark_as_advanced(KITH_EMXX KITH_EMSCRIPTEN_TOOLCHAIN)
set(engine ${PROJECT_BINARY_DIR}/engine)
add_custom_command(OUTPUT ${engine}/build.ninja
  COMMAND ${CMAKE_COMMAND} -S ${PROJECT_SOURCE_DIR}/apps/lesson -B ${engine} -G Ninja -Wno-dev
    -D CMAKE_TOOLCHAIN_FILE=${KITH_EMSCRIPTEN_TOOLCHAIN} -D CMAKE_BUILD_TYPE=Release
  DEPENDS ${PROJECT_SOURCE_DIR}/apps/lesson/CMakeLists.txt COMMENT "Configuring the engine of lesson files" VERBATIM)
# Knows by itself what to compile again. Debian's Emscripten finds its packages where Debian's Node.js looks.
add_custom_target(kith_engine
  COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs ${CMAKE_COMMAND} --build ${engine}
  DEPENDS ${engine}/build.ninja BYPRODUCTS ${engine}/kith_engine.js ${engine}/kith_engine.wasm
  COMMENT "Compiling the engine of lesson files" VERBATIM)
set(lesson_file_page ${PROJECT_BINARY_DIR}/web/lesson_file.html)
file(GLOB_RECURSE lesson_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/web/src/*)
add_custom_command(OUTPUT ${lesson_file_page}
  COMMAND ${KITH_NODE} ${PROJECT_SOURCE_DIR}/web/build.mjs --page file --engine ${engine}
    --modules ${PROJECT_BINARY_DIR}/web --out ${lesson_file_page}
  DEPENDS kith_engine kith_web_packages ${engine}/kith_engine.js ${engine}/kith_engine.wasm
    ${PROJECT_SOURCE_DIR}/web/build.mjs ${PROJECT_SOURCE_DIR}/web/bundle.mjs ${PROJECT_SOURCE_DIR}/web/pack.mjs ${lesson_sources}
  COMMENT "Bundling lesson files" VERBATIM)
if(KITH_BUILD_TESTS AND KITH_CHROMIUM)
  add_test(NAME web.LessonFile COMMAND ${KITH_NODE} ${PROJECT_SOURCE_DIR}/web/tests/file_test.mjs
    --kith $<TARGET_FILE:kith> --modules ${PROJECT_BINARY_DIR}/web --chromium ${KITH_CHROMIUM})
  add_test(NAME web.LessonDoors COMMAND ${KITH_NODE} ${PROJECT_SOURCE_DIR}/web/tests/doors_test.mjs
    --kith $<TARGET_FILE:kith> --modules ${PROJECT_BINARY_DIR}/web --chromium ${KITH_CHROMIUM})
  add_test(NAME web.LessonSessions COMMAND ${KITH_NODE} ${PROJECT_SOURCE_DIR}/web/tests/sessions_test.mjs
    --kith $<TARGET_FILE:kith> --engine ${engine})
  set_tests_properties(web.LessonSessions PROPERTIES TIMEOUT 1200 LABELS web)
  set_tests_properties(web.LessonFile web.LessonDoors PROPERTIES ${browser_of_files} TIMEOUT 1200 LABELS web)
  find_program(KITH_FIREFOX NAMES firefox-esr firefox DOC "Second browser that tests lesson files")
  mark_as_advanced(KITH_FIREFOX)
  if(KITH_FIREFOX)
    add_test(NAME web.LessonFirefox COMMAND ${KITH_NODE} ${PROJECT_SOURCE_DIR}/web/tests/firefox_test.mjs
      --kith $<TARGET_FILE:kith> --modules ${PROJECT_BINARY_DIR}/web --firefox ${KITH_FIREFOX})
    set_tests_properties(web.LessonFirefox PROPERTIES ${browser_of_files} TIMEOUT 1200 LABELS web)
  endif()
endif()
