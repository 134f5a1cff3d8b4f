# Defines Libyaml::Libyaml, which has no CMake package of its own. Installed with kith, whose packages need it too.
find_path(Libyaml_INCLUDE_DIR yaml.h)
find_library(Libyaml_LIBRARY yaml)
mark_as_advanced(Libyaml_INCLUDE_DIR Libyaml_LIBRARY)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Libyaml REQUIRED_VARS Libyaml_LIBRARY Libyaml_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "apt-get install libyaml-dev")
if(Libyaml_FOUND AND NOT TARGET Libyaml::Libyaml)
  add_library(Libyaml::Libyaml UNKNOWN IMPORTED)
  set_target_properties(Libyaml::Libyaml PROPERTIES
    IMPORTED_LOCATION "${Libyaml_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${Libyaml_INCLUDE_DIR}")
endif()
