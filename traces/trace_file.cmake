# The trace file: MCAP records, FlatBuffers messages, writer, reader, summary. Included by traces/CMakeLists.txt.
find_package(FlatBuffers 2.0.8 REQUIRED)
find_program(FLATC flatc REQUIRED)

# Headers and binary schemas are generated at every build and live in the build tree only.
set(schema_folder ${PROJECT_BINARY_DIR}/generated_schemas)
set(schema_headers)
foreach(schema pose_frame collider_frame event foxglove scene_update frame_transforms)
  set(outputs ${schema_folder}/schemas/${schema}_generated.h)
  if(NOT schema STREQUAL foxglove)  # which the two behind it include
    list(APPEND outputs ${schema_folder}/schemas/${schema}_bfbs_generated.h)
  endif()
  add_custom_command(
    OUTPUT ${outputs}
    COMMAND ${FLATC} --cpp --cpp-std c++17 --scoped-enums --bfbs-comments --bfbs-gen-embed
      -o ${schema_folder}/schemas ${CMAKE_CURRENT_SOURCE_DIR}/schemas/${schema}.fbs
    DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/schemas/${schema}.fbs ${CMAKE_CURRENT_SOURCE_DIR}/schemas/foxglove.fbs
    COMMENT "Generating the ${schema} schema"
    VERBATIM)
  list(APPEND schema_headers ${outputs})
endforeach()

target_sources(vestige_traces PRIVATE
  ${schema_headers}
  files/append_file.cpp
  trace_file/definitions.cpp
  repair/frame_gate.cpp
  recording/frame_ring.cpp
  mcap/byte_source.cpp
  mcap/chunk_expander.cpp
  mcap/check/chunk_check.cpp
  mcap/check/chunk_salvage.cpp
  mcap/compression.cpp
  mcap/check/container_check.cpp
  mcap/crc32.cpp
  mcap/decode.cpp
  mcap/encode.cpp
  mcap/indexed_reader.cpp
  mcap/record_walker.cpp
  mcap/stream_reader.cpp
  mcap/summary.cpp
  mcap/check/summary_check.cpp
  mcap/writer.cpp
  trace_file/mcap_output.cpp
  repair/merge.cpp
  repair/message_text.cpp
  recording/recorder.cpp
  repair/recover.cpp
  repair/rewrite.cpp
  repair/trace_check.cpp
  trace_file/trace_format.cpp
  trace_file/trace_messages.cpp
  trace_file/trace_nodes.cpp
  trace_file/message_stream.cpp
  trace_file/trace_index.cpp
  trace_file/trace_reader.cpp
  repair/trace_summary.cpp
  trace_file/trace_writer.cpp
  trace_file/viz_messages.cpp)
target_include_directories(vestige_traces SYSTEM PRIVATE ${schema_folder})
target_link_libraries(vestige_traces PRIVATE vestige_version Threads::Threads)

# What comes in live; apart, so that programs that record nothing do not need liblo.
add_library(vestige_live STATIC
  live/live_ndjson.cpp
  live/live_recording.cpp
  live/osc_packet.cpp
  recording/recording_thread.cpp
  live/udp_receiver.cpp
  live/vmc_state.cpp)
target_link_libraries(vestige_live PUBLIC vestige_traces
  PRIVATE PkgConfig::LIBLO nlohmann_json::nlohmann_json Threads::Threads)
