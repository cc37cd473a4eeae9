# A room is a folder with one purpose; CONTRIBUTING.md lists them. vestige_room(FOLDER [USES FOLDER…] [LIBRARIES …]
# [EXCEPT FILE…] [COLD]) makes the library of one: every .cpp that lies in FOLDER, EXCEPT those named. Its files may include
# what lies in FOLDER and in the rooms that it USES, and nothing else of ours: tests/arrows.py reads these calls and refuses
# any other include. A COLD room has no loop that is waited for: -O1 builds it in two thirds of the time, and under a sanitizer
# -O0 in two thirds of that. The library of traces/base is vestige_traces_base.
set(vestige_cold_level $<IF:$<BOOL:${VESTIGE_SANITIZED}>,-O0,$<$<NOT:$<CONFIG:Debug>>:-O1>>)
function(vestige_room folder)
  cmake_parse_arguments(ARG "COLD" "" "USES;LIBRARIES;EXCEPT" ${ARGN})
  string(REPLACE / _ name vestige_${folder})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.cpp)
  list(TRANSFORM ARG_EXCEPT PREPEND ${PROJECT_SOURCE_DIR}/${folder}/)
  list(REMOVE_ITEM sources "" ${ARG_EXCEPT})  # "": it wants an item, even if ARG_EXCEPT has none
  add_library(${name} STATIC ${sources})
  list(TRANSFORM ARG_USES REPLACE / _)
  list(TRANSFORM ARG_USES PREPEND vestige_)
  target_link_libraries(${name} PUBLIC vestige_options ${ARG_USES} PRIVATE ${ARG_LIBRARIES})
  if(ARG_COLD)
    target_compile_options(${name} PRIVATE ${vestige_cold_level})
    target_precompile_headers(${name} REUSE_FROM vestige_precompiled_cold)
  else()
    target_precompile_headers(${name} REUSE_FROM vestige_precompiled)
  endif()
endfunction()
