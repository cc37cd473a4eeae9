# Tests of vestige-plot; included where that target exists.
find_package(EXPAT REQUIRED)

vestige_test(plot_layout_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/plot_layout_test.cpp
  LIBRARIES vestige_plotting)
vestige_test(plot_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/plot_test.cpp
  LIBRARIES vestige_traces EXPAT::EXPAT PNG::PNG OpenEXR::OpenEXR)
add_dependencies(plot_test vestige-plot)
