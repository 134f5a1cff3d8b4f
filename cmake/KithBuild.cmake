# How every translation unit of kith is compiled. Linked PRIVATE, so none of it
# reaches users of the libraries.
#
# The baseline is x86-64-v2; contraction and fast-math stay off, because the
# bits of a result are part of the result.
add_library(kith_build INTERFACE)
target_compile_options(kith_build INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor -Wold-style-cast
  -Woverloaded-virtual -Wdouble-promotion -Wimplicit-fallthrough
  -ffp-contract=off -fno-fast-math $<$<BOOL:${KITH_WERROR}>:-Werror>)
target_compile_definitions(kith_build INTERFACE _GLIBCXX_ASSERTIONS)
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
  target_compile_options(kith_build INTERFACE -march=x86-64-v2)
endif()
if(KITH_SANITIZE)
  target_compile_options(kith_build INTERFACE -fsanitize=${KITH_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(kith_build INTERFACE -fsanitize=${KITH_SANITIZE})
else()
  target_compile_options(kith_build INTERFACE -fstack-protector-strong $<$<CONFIG:Release>:-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2>)
  target_link_options(kith_build INTERFACE -Wl,-z,relro,-z,now)
endif()
