# Tests of vestige-plot; included where that target exists.
find_package(EXPAT REQUIRED)

vestige_test(plot_layout_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/plot/plot_layout_test.cpp ${CMAKE_CURRENT_LIST_DIR}/plot/contact_density_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/plot/depth_map_test.cpp
  LIBRARIES vestige_plotting)
vestige_test(plot_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/plot/plot_test.cpp
  LIBRARIES vestige_traces EXPAT::EXPAT PNG::PNG OpenEXR::OpenEXR)
add_dependencies(plot_test vestige-plot)
vestige_test(plot_stress_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/plot/plot_stress_test.cpp
  LIBRARIES vestige_traces EXPAT::EXPAT PNG::PNG)
add_dependencies(plot_stress_test vestige-plot)
vestige_test(plot_body_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/plot/plot_body_test.cpp ${CMAKE_CURRENT_LIST_DIR}/plot/plot_scene_test.cpp
  LIBRARIES vestige_traces EXPAT::EXPAT PNG::PNG)
add_dependencies(plot_body_test vestige vestige-plot)
find_package(VTK 9.1 REQUIRED COMPONENTS CommonCore CommonDataModel IOXML)
vestige_test(plot_paraview_test
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/plot/plot_paraview_test.cpp
  LIBRARIES vestige_traces EXPAT::EXPAT PNG::PNG nlohmann_json::nlohmann_json VTK::CommonCore VTK::CommonDataModel VTK::IOXML)
add_dependencies(plot_paraview_test vestige vestige-plot)
vestige_test(plot_report_test LONG
  SOURCES ${CMAKE_CURRENT_LIST_DIR}/plot/plot_report_test.cpp
  LIBRARIES vestige_traces EXPAT::EXPAT PNG::PNG nlohmann_json::nlohmann_json)
add_dependencies(plot_report_test vestige vestige-plot)
