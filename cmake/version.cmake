# Writes generated/version.hpp at every build, so that a result file names the commit it came from.
add_custom_target(vestige_version_header
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DOUT=${PROJECT_BINARY_DIR}/generated/version.hpp
    -DVERSION=${PROJECT_VERSION} -P ${PROJECT_SOURCE_DIR}/cmake/write_version.cmake
  BYPRODUCTS ${PROJECT_BINARY_DIR}/generated/version.hpp
  COMMENT "Noting the commit")
add_library(vestige_version INTERFACE)
add_dependencies(vestige_version vestige_version_header)
