# cmake -D INPUT=a.toml -D OUTPUT=a.cpp -D NAME=kItemDeliveryText -P embed_text.cmake
#
# Writes a source file that defines the constant `NAME` with the text of a file.
# One raw string may have 64 KiB by the standard's recommended minimum; domain
# files are far smaller.
file(READ ${INPUT} text)
string(FIND "${text}" ")kith\"" clash)
if(NOT clash EQUAL -1)
  message(FATAL_ERROR "${INPUT} contains the delimiter of a raw string")
endif()
file(WRITE ${OUTPUT} "#include \"built_in.hpp\"

namespace kith::detail {
const std::string_view ${NAME} = R\"kith(${text})kith\";
}  // namespace kith::detail
")
