# kith_embed_text(<target> <file> <constant> [HEADER header])
#
# Makes the text of a file a constant in a source file of the target: `kith::detail::<constant>`, a
# std::string_view that `header` (built_in.hpp) among the target's sources declares.
function(kith_embed_text target file constant)
  cmake_parse_arguments(PARSE_ARGV 3 arg "" "HEADER" "")
  if(NOT arg_HEADER)
    set(arg_HEADER built_in.hpp)
  endif()
  set(script ${PROJECT_SOURCE_DIR}/cmake/EmbedText.cmake)
  cmake_path(GET file FILENAME name)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -D INPUT=${file} -D OUTPUT=${output} -D NAME=${constant} -D HEADER=${arg_HEADER}
            -P ${script}
    DEPENDS ${file} ${script} VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
