# cmake -D INPUT=a.toml -D OUTPUT=a.cpp -D NAME=kItemDeliveryText -D HEADER=built_in.hpp -P EmbedText.cmake
#
# Writes a source file that defines the constant NAME, which HEADER declares, with the text of a file. A text
# becomes one raw string however long it is: g++ and clang compile 2 MB in a second.
file(READ ${INPUT} text)
string(FIND "${text}" ")kith\"" clash)
if(NOT clash EQUAL -1)
  message(FATAL_ERROR "${INPUT} contains the delimiter of a raw string")
endif()
file(WRITE ${OUTPUT} "#include \"${HEADER}\"

namespace kith::detail {
const std::string_view ${NAME} = R\"kith(${text})kith\";
}  // namespace kith::detail
")
