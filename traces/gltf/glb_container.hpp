#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "traces/gltf/json/gltf_report.hpp"

namespace vestige::gltf {

/// The two chunks of a binary glTF file (glTF 2.0 §4.4), as views into it.
struct GlbChunks {
  std::string_view json;
  std::span<const std::byte> bin;  ///< empty where there is no BIN chunk
};

/// Checks magic, version and all lengths, and that the chunks are JSON, at most one BIN, then unknown ones (skipped
/// with a warning, as are bytes behind the end). Fails naming the byte offset.
GlbChunks split_glb(std::span<const std::byte> glb, Report& report);

/// The reverse: header, JSON padded with spaces, BIN padded with zeros (left out when empty). Fails beyond 4 GiB.
std::vector<std::byte> join_glb(std::string_view json, std::span<const std::byte> bin, const Report& report);

}  // namespace vestige::gltf
