# Defines Libqrencode::Libqrencode, which has no CMake package of its own. Installed with kith, whose packages need it
# too.
find_path(Libqrencode_INCLUDE_DIR qrencode.h)
find_library(Libqrencode_LIBRARY qrencode)
mark_as_advanced(Libqrencode_INCLUDE_DIR Libqrencode_LIBRARY)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Libqrencode REQUIRED_VARS Libqrencode_LIBRARY Libqrencode_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "apt-get install libqrencode-dev")
if(Libqrencode_FOUND AND NOT TARGET Libqrencode::Libqrencode)
  add_library(Libqrencode::Libqrencode UNKNOWN IMPORTED)
  set_target_properties(Libqrencode::Libqrencode PROPERTIES
    IMPORTED_LOCATION "${Libqrencode_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${Libqrencode_INCLUDE_DIR}")
endif()
