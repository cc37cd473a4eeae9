# Two Debian packages: vestige, and vestige-plot, which needs VTK. Target `deb` writes them to packages/.
set(CPACK_GENERATOR DEB)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_PACKAGE_NAME vestige)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "the Vestige authors <vestige@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_OUTPUT_FILE_PREFIX ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)

set(CPACK_COMPONENTS_ALL vestige)
set(CPACK_DEBIAN_VESTIGE_PACKAGE_NAME vestige)
set(CPACK_COMPONENT_VESTIGE_DESCRIPTION
"collision-driven haptics: record, replay and measure
Vestige records traces of an animated avatar and the colliders around it,
replays them through a geometry-shader collision detector, says which
vibrator of a haptic vest fires when, and measures the detector.")
# OpenGL, Embree, HDF5 and libwebsockets are opened at run time, which dpkg-shlibdeps does not see.
set(CPACK_DEBIAN_VESTIGE_PACKAGE_RECOMMENDS "libegl1, libegl-mesa0, libgl1-mesa-dri")
set(CPACK_DEBIAN_VESTIGE_PACKAGE_SUGGESTS "vestige-plot, libosmesa6, libembree3-3, libhdf5-103-1, libwebsockets17")
set(deb_depends vestige ${share}/vestige.stamp)

# Copyright, README and changelog, where Debian wants them.
set(date_command git -C ${PROJECT_SOURCE_DIR} log -1 --format=%cD)
execute_process(COMMAND ${date_command} OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT date)
  set(date "Thu, 01 Jan 1970 00:00:00 +0000")
endif()
foreach(package vestige vestige-plot)
  set(folder ${PROJECT_BINARY_DIR}/packages/doc/${package})
  file(WRITE ${folder}/changelog "vestige (${PROJECT_VERSION}) unstable; urgency=medium\n\n"
    "  * See the commits.\n\n -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
  execute_process(COMMAND ${GZIP} -9nf ${folder}/changelog COMMAND_ERROR_IS_FATAL ANY)
  configure_file(${PROJECT_SOURCE_DIR}/LICENSE ${folder}/copyright COPYONLY)
  if(package STREQUAL vestige OR TARGET vestige-plot)
    install(FILES ${folder}/changelog.gz ${folder}/copyright DESTINATION share/doc/${package} COMPONENT ${package})
  endif()
endforeach()
install(FILES README.md DESTINATION share/doc/vestige COMPONENT vestige)

if(TARGET vestige-plot)
  list(APPEND CPACK_COMPONENTS_ALL vestige-plot)
  set(CPACK_DEBIAN_VESTIGE-PLOT_PACKAGE_NAME vestige-plot)
  set(CPACK_COMPONENT_VESTIGE-PLOT_DESCRIPTION
"figures of what vestige measured
Draws avatars, bodies with their actuator regions and contacts, scenes of
traces, detection frequencies, collision textures and actuator timelines, as
SVG and PNG, and films of traces. It is run as \"vestige plot\".")
  set(CPACK_DEBIAN_VESTIGE-PLOT_PACKAGE_DEPENDS "vestige (= ${PROJECT_VERSION}), fonts-liberation2")
  set(CPACK_DEBIAN_VESTIGE-PLOT_PACKAGE_RECOMMENDS "libegl1, libegl-mesa0, libgl1-mesa-dri")
  list(APPEND deb_depends vestige-plot ${share}/vestige-plot.stamp)
endif()

include(CPack)
set(deb_stamp ${PROJECT_BINARY_DIR}/packages/deb.stamp)
add_custom_command(OUTPUT ${deb_stamp}
  COMMAND sh -c "rm -f ${PROJECT_BINARY_DIR}/packages/*.deb"  # of other versions
  COMMAND ${CMAKE_CPACK_COMMAND} -G DEB --config ${PROJECT_BINARY_DIR}/CPackConfig.cmake
  COMMAND ${CMAKE_COMMAND} -E touch ${deb_stamp}
  DEPENDS ${deb_depends} ${PROJECT_SOURCE_DIR}/cmake/package.cmake ${PROJECT_SOURCE_DIR}/README.md
  COMMENT "Making the Debian packages"
  VERBATIM)
add_custom_target(deb DEPENDS ${deb_stamp})
