# Run with cmake -P at every build; see KithBuildInfo.cmake.
#
# The commit comes from git where there is a repository, else from the file
# that `git archive` fills in, else it is "unknown".
set(GIT_ID "unknown")
set(GIT_DIRTY false)
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE_DIR}/.git)
  execute_process(COMMAND ${GIT} -C ${SOURCE_DIR} describe --tags --always --abbrev=12
    OUTPUT_VARIABLE id OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(NOT failed)
    set(GIT_ID ${id})
    execute_process(COMMAND ${GIT} -C ${SOURCE_DIR} --no-optional-locks status --porcelain --untracked-files=no
      OUTPUT_VARIABLE changes ERROR_QUIET)
    if(changes)
      set(GIT_DIRTY true)
    endif()
  endif()
elseif(EXISTS ${SOURCE_DIR}/.git_archival.txt)
  file(READ ${SOURCE_DIR}/.git_archival.txt archived)
  if(archived MATCHES "commit: ([0-9a-f]+)")
    set(GIT_ID ${CMAKE_MATCH_1})
  endif()
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/kith_build_info.hpp.in ${OUTPUT} @ONLY)
