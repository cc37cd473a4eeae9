# Tests of vestige-plot; included where that target exists.
find_package(EXPAT REQUIRED)
find_package(PNG REQUIRED)
pkg_check_modules(OPENEXR REQUIRED IMPORTED_TARGET OpenEXR)

vestige_test(plot_layout_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/plot_layout_test.cpp
  LIBRARIES vestige_plotting)
vestige_test(plot_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/plot_test.cpp
  LIBRARIES vestige_traces EXPAT::EXPAT PNG::PNG PkgConfig::OPENEXR)
add_dependencies(plot_test vestige-plot)
