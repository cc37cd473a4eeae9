# What an installation consists of: programs, man pages, completion scripts. Pages and scripts are asked of the programs.
include(GNUInstallDirs)
find_program(GZIP gzip REQUIRED)

set(share ${PROJECT_BINARY_DIR}/share)
function(vestige_generated_share component stamp)
  cmake_parse_arguments(ARG "" "" "COMMANDS;DEPENDS" ${ARGN})
  add_custom_command(OUTPUT ${stamp} ${ARG_COMMANDS} COMMAND ${CMAKE_COMMAND} -E touch ${stamp} DEPENDS ${ARG_DEPENDS}
    COMMENT "Writing man pages and completion of ${component}" VERBATIM)
endfunction()

set(folder ${share}/vestige)
vestige_generated_share(vestige ${folder}.stamp DEPENDS vestige COMMANDS
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${folder}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${folder}/man/man1 ${folder}/bash-completion/completions
    ${folder}/zsh/vendor-completions ${folder}/fish/vendor_completions.d
  COMMAND vestige man --pages ${folder}/man/man1
  COMMAND sh -c "${GZIP} -9n ${folder}/man/man1/*.1"
  COMMAND vestige completion bash > ${folder}/bash-completion/completions/vestige
  COMMAND vestige completion zsh > ${folder}/zsh/vendor-completions/_vestige
  COMMAND vestige completion fish > ${folder}/fish/vendor_completions.d/vestige.fish)
add_custom_target(vestige_share ALL DEPENDS ${folder}.stamp)
install(TARGETS vestige COMPONENT vestige)
install(DIRECTORY ${folder}/ DESTINATION ${CMAKE_INSTALL_DATAROOTDIR} COMPONENT vestige)

if(TARGET vestige-plot)
  set(folder ${share}/vestige-plot)
  vestige_generated_share(vestige-plot ${folder}.stamp DEPENDS vestige-plot COMMANDS
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${folder}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${folder}/man/man1
    COMMAND vestige-plot man > ${folder}/man/man1/vestige-plot.1
    COMMAND ${GZIP} -9n ${folder}/man/man1/vestige-plot.1)
  add_custom_target(vestige_plot_share ALL DEPENDS ${folder}.stamp)
  install(TARGETS vestige-plot COMPONENT vestige-plot)
  install(DIRECTORY ${folder}/ DESTINATION ${CMAKE_INSTALL_DATAROOTDIR} COMPONENT vestige-plot)
endif()

# The reference, as the programs write it.
set(reference ${PROJECT_SOURCE_DIR}/docs/reference)
if(TARGET vestige-plot)
  set(plot_page COMMAND vestige-plot man --markdown > ${reference}/plot.md)
endif()
add_custom_target(reference COMMAND vestige man --markdown ${reference} --force ${plot_page}
  COMMAND vestige explain > ${reference}/files.md
  COMMENT "Writing docs/reference" VERBATIM)

# The bundle: `vestige` and the programs of agreement, with their libraries, for a machine where nothing is installed.
set(vestige_bundle ${PROJECT_BINARY_DIR}/bundle/vestige-${PROJECT_VERSION}-x86_64)
find_program(PATCHELF patchelf)
add_custom_command(OUTPUT ${vestige_bundle}.stamp
  COMMAND ${CMAKE_COMMAND} -DVESTIGE=$<TARGET_FILE:vestige> -DAGREEMENT=$<TARGET_FILE:agreement>
    -DGEOMETRY_AGREEMENT=$<TARGET_FILE:geometry_agreement> -DPATCHELF=${PATCHELF} -DSTRIP=${CMAKE_STRIP}
    -DBUNDLE=${vestige_bundle} -DSHARE=${share}/vestige -DSOURCE=${PROJECT_SOURCE_DIR} -DVERSION=${PROJECT_VERSION}
    -P ${PROJECT_SOURCE_DIR}/cmake/bundle.cmake
  COMMAND ${CMAKE_COMMAND} -E touch ${vestige_bundle}.stamp
  DEPENDS vestige agreement geometry_agreement ${share}/vestige.stamp cmake/bundle.cmake cmake/measure.sh cmake/bundle_readme.txt
  COMMENT "Bundling ${vestige_bundle}"
  VERBATIM)
add_custom_target(bundle DEPENDS ${vestige_bundle}.stamp)
