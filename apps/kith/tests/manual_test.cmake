# cmake -D KITH=<program> -D WORK_DIR=<folder> -P manual_test.cmake
#
# Every command has a man page, and troff has no complaint about any of them.
file(REMOVE_RECURSE ${WORK_DIR})
execute_process(COMMAND ${CMAKE_COMMAND} -D KITH=${KITH} -D OUTPUT_DIR=${WORK_DIR}
  -P ${CMAKE_CURRENT_LIST_DIR}/../../../cmake/WriteManual.cmake COMMAND_ERROR_IS_FATAL ANY)
file(GLOB pages ${WORK_DIR}/*.1)
list(LENGTH pages number)
if(number LESS 20)
  message(FATAL_ERROR "only ${number} man pages")
endif()
find_program(man man)
find_program(groff groff)
foreach(page ${pages})
  file(READ ${page} text)
  foreach(section NAME "SEE ALSO")
    if(NOT text MATCHES "\n[.]SH ${section}\n")
      message(FATAL_ERROR "${page} has no section ${section}")
    endif()
  endforeach()
  if(NOT man OR NOT groff)
    continue()
  endif()
  execute_process(COMMAND ${CMAKE_COMMAND} -E env MANWIDTH=100 LC_ALL=C ${man} --warnings -l ${page}
    OUTPUT_VARIABLE shown ERROR_VARIABLE complaints RESULT_VARIABLE result)
  if(NOT result EQUAL 0 OR NOT complaints STREQUAL "" OR NOT shown MATCHES "SEE ALSO")
    message(FATAL_ERROR "${page}: ${result} ${complaints}")
  endif()
endforeach()
