# Run with -P: fills BUNDLE with VESTIGE, AGREEMENT and GEOMETRY_AGREEMENT, every library that they need but glibc's, their
# licences, and ./measure.
if(NOT PATCHELF)
  message(FATAL_ERROR "bundle: patchelf is missing\n  apt-get install patchelf, and configure again")
endif()

set(programs ${VESTIGE} ${AGREEMENT} ${GEOMETRY_AGREEMENT})
# glibc is what the other machine brings.
set(glibc "^(libc|libm|libdl|libpthread|librt|ld-linux-x86-64)\\.so")
file(GET_RUNTIME_DEPENDENCIES EXECUTABLES ${programs} RESOLVED_DEPENDENCIES_VAR libraries
  PRE_EXCLUDE_REGEXES ${glibc} POST_EXCLUDE_REGEXES "/ld-linux-x86-64\\.so")

# One process can hold one library of a name only, and OpenGL drivers need these too, perhaps in a newer version than
# ours: the machine's own is taken where it has one.
set(of_drivers "^(libstdc\\+\\+|libgcc_s|libz|libzstd)\\.so")
set(system_folders /usr/lib/x86_64-linux-gnu:/lib/x86_64-linux-gnu:/usr/lib64:/lib64:/usr/lib:/lib)

file(REMOVE_RECURSE ${BUNDLE})
file(MAKE_DIRECTORY ${BUNDLE}/bin ${BUNDLE}/lib/fallback ${BUNDLE}/licences)

# A copy without symbols under the name that it is asked for by, which looks for its own needs in `rpath`.
function(bundle_file file destination rpath)
  get_filename_component(name ${file} NAME)
  file(REAL_PATH ${file} real)
  get_filename_component(real_name ${real} NAME)
  file(COPY ${real} DESTINATION ${destination})
  if(NOT name STREQUAL real_name)
    file(RENAME ${destination}/${real_name} ${destination}/${name})
  endif()
  execute_process(COMMAND ${STRIP} --strip-unneeded ${destination}/${name} COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${PATCHELF} --set-rpath ${rpath} ${destination}/${name} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# The licence of the Debian package that a file comes from, and the common ones that it names.
function(bundle_licence package)
  if(EXISTS ${BUNDLE}/licences/${package}.txt)
    return()
  endif()
  file(REAL_PATH /usr/share/doc/${package}/copyright copyright)
  configure_file(${copyright} ${BUNDLE}/licences/${package}.txt COPYONLY)
  file(READ ${copyright} text)
  string(REGEX MATCHALL "/usr/share/common-licenses/[A-Za-z0-9.-]*[A-Za-z0-9]" common "${text}")
  list(REMOVE_DUPLICATES common)
  foreach(licence IN LISTS common)
    file(REAL_PATH ${licence} real)
    get_filename_component(name ${licence} NAME)
    if(EXISTS ${real})
      configure_file(${real} ${BUNDLE}/licences/common/${name} COPYONLY)
    endif()
  endforeach()
endfunction()

foreach(program IN LISTS programs)
  bundle_file(${program} ${BUNDLE}/bin "$ORIGIN/../lib:${system_folders}:$ORIGIN/../lib/fallback")
endforeach()
foreach(library IN LISTS libraries)
  get_filename_component(name ${library} NAME)
  if(name MATCHES ${of_drivers})
    bundle_file(${library} ${BUNDLE}/lib/fallback "$ORIGIN/..:${system_folders}:$ORIGIN")
  else()
    bundle_file(${library} ${BUNDLE}/lib "$ORIGIN:${system_folders}:$ORIGIN/fallback")
  endif()
  file(REAL_PATH ${library} real)
  # Where /lib is a link to /usr/lib, dpkg may know a file by either name.
  string(REGEX REPLACE "^/usr" "" short ${real})
  execute_process(COMMAND dpkg-query -S ${real} ${short} OUTPUT_VARIABLE owner ERROR_QUIET)
  if(NOT owner MATCHES "^([a-z0-9.+-]+)")
    message(FATAL_ERROR "bundle: no package owns ${real}, so its licence is unknown")
  endif()
  bundle_licence(${CMAKE_MATCH_1})
endforeach()
# What is compiled into the program.
foreach(package libcli11-dev nlohmann-json3-dev libglm-dev libeigen3-dev libflatbuffers-dev libjs-three)
  bundle_licence(${package})
endforeach()
configure_file(${SOURCE}/LICENSE ${BUNDLE}/licences/vestige.txt COPYONLY)

file(COPY ${SHARE}/ DESTINATION ${BUNDLE}/share)
configure_file(${SOURCE}/cmake/bundle_readme.txt ${BUNDLE}/README @ONLY)
file(COPY ${SOURCE}/cmake/measure.sh DESTINATION ${BUNDLE}
  FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
file(RENAME ${BUNDLE}/measure.sh ${BUNDLE}/measure)

file(GLOB_RECURSE files LIST_DIRECTORIES false ${BUNDLE}/*)
set(bytes 0)
foreach(file IN LISTS files)
  file(SIZE ${file} size)
  math(EXPR bytes "${bytes} + ${size}")
endforeach()
math(EXPR mib "(${bytes} + 1048575) / 1048576")
message(STATUS "bundle: ${BUNDLE}, ${mib} MiB")
